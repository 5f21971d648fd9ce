"""Build the paper where TeX exists; elsewhere say what to install and go on."""

from __future__ import annotations

import logging
import os
import shutil
import subprocess
import tempfile
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from mobnet.core.errors import DataError, MobnetError
from mobnet.core.files import atomic_path, write_json

log = logging.getLogger(__name__)

NEEDED = {  # file that TeX must find -> Debian package that brings it
    "article.cls": "texlive-latex-base",
    "booktabs.sty": "texlive-latex-recommended",
    "IEEEtran.cls": "texlive-publishers",
    "ptmr7t.tfm": "texlive-fonts-recommended",
}
PACKAGES = ("texlive-latex-recommended", "texlive-publishers", "texlive-fonts-recommended", "latexmk")
LOG_LINES = 15
EPOCH = "0"  # date of the PDF unless SOURCE_DATE_EPOCH says another: equal input gives equal bytes


class PaperError(MobnetError):
    """TeX is there but could not set the paper."""


def build(
    config: Mapping[str, Any], main_tex: Path, tables_dir: Path, figures_dir: Path, snapshot_dir: Path, out_pdf: Path
) -> None:
    """Set the paper with latexmk and write a status file beside the PDF, also where TeX is missing.

    Args:
        config: resolved configuration; its scale is noted.
        main_tex: the paper; refs.bib lies beside it.
        tables_dir: tables that it inputs, *.tex.
        figures_dir: figures that it includes, *.pdf.
        snapshot_dir: tables that it inputs as they were committed, *.tex: what differs from run to run.
        out_pdf: the PDF; `build.json` beside it says whether it was built, and what is missing if not.

    Raises:
        PaperError: TeX failed; the message holds the end of its log.
        DataError: the paper's source is missing.
    """
    if not main_tex.is_file():
        raise DataError(f"{main_tex}: file is missing")
    missing = missing_packages()
    out_pdf.unlink(missing_ok=True)
    if missing:
        log.warning("%s: no PDF, TeX is not complete; install: apt-get install %s", out_pdf, " ".join(PACKAGES))
    else:
        with tempfile.TemporaryDirectory() as folder:
            compile_pdf(collect(main_tex, tables_dir, figures_dir, snapshot_dir, Path(folder)), out_pdf)
    status = {"scale": config["scale"], "pdf": None if missing else out_pdf.name, "missing_packages": missing}
    write_json(out_pdf.with_name("build.json"), status)


def missing_packages() -> list[str]:
    """Return the Debian packages that are needed and not installed."""
    if shutil.which("latexmk") is None or shutil.which("kpsewhich") is None:
        return list(PACKAGES)
    return [package for name, package in NEEDED.items() if not _found(name)]


def _found(name: str) -> bool:
    """Return whether TeX finds a file."""
    return subprocess.run(["kpsewhich", name], capture_output=True, check=False).returncode == 0


def collect(main_tex: Path, tables_dir: Path, figures_dir: Path, snapshot_dir: Path, folder: Path) -> Path:
    """Copy the paper's source, tables and figures into an empty folder and return the copy of the source."""
    for source in (main_tex, *main_tex.parent.glob("*.bib")):
        shutil.copy(source, folder / source.name)
    for name, source_dir in (("tables", tables_dir), ("figures", figures_dir), ("snapshot", snapshot_dir)):
        (folder / name).mkdir()
        for source in sorted(source_dir.glob("*.pdf" if name == "figures" else "*.tex")):
            shutil.copy(source, folder / name / source.name)
    return folder / main_tex.name


def compile_pdf(source: Path, out_pdf: Path) -> None:
    """Run latexmk in the source's folder and put the PDF in its place.

    Raises:
        PaperError: TeX failed; the message holds the end of its log.
    """
    run = subprocess.run(
        latexmk_command(source.name), cwd=source.parent, capture_output=True, text=True, errors="replace", check=False,
        stdin=subprocess.DEVNULL, env={**os.environ, "SOURCE_DATE_EPOCH": os.environ.get("SOURCE_DATE_EPOCH", EPOCH)},
    )  # fmt: skip
    if run.returncode != 0:
        lines = [line for line in run.stdout.splitlines() if line.strip()]
        raise PaperError(f"{out_pdf}: latexmk ended with {run.returncode}:\n" + "\n".join(lines[-LOG_LINES:]))
    with atomic_path(out_pdf) as temporary:
        shutil.copy(source.with_suffix(".pdf"), temporary)


def latexmk_command(name: str) -> Sequence[str]:
    """Return the command that sets a paper whose tables and figures lie in folders beside it."""
    folders = r"\def\tables{tables}\def\figures{figures}\def\snapshot{snapshot}"
    return ("latexmk", "-pdf", "-norc", "-interaction=nonstopmode", "-halt-on-error", f"-usepretex={folders}", name)
