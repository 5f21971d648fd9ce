"""The paper as PDF where TeX is installed; elsewhere a note of what to install."""

import logging
import os
import re
import shutil
import subprocess
import tempfile
from collections.abc import Mapping, Sequence
from pathlib import Path

from experiments.evaluation.report.type_sizes import printed_types, type_faults
from experiments.settings.pages import PaperText
from mobnet.core.errors import DataError, MobnetError
from mobnet.core.files import atomic_path, check_room, read_json, read_text, write_json

LABEL = re.compile(r"\\newlabel\{(?P<name>[^{}]+)\}\{\{(?:[^{}]|\{[^{}]*\})*\}\{(?P<page>\d+)\}")
END = "end:main"  # label of the end of the main text
FIRST = "at:"  # before the label of a float: where the text mentions it first
FAR = 2  # pages between a float of the main text and its first mention
OVERFULL_PT = 5.0  # less is hardly seen beside a column of text
INPUT = re.compile(r"\(\./([\w./-]+\.tex)")
NAMES = re.compile(  # labels that stand twice, and labels and works that do not exist
    r"Label `[^']*' multiply defined|(?:Reference|Citation) `[^']*'(?: on page \d+)? undefined"
)
LARGE = re.compile(
    r"Overfull \\[hv]box \((?P<box>[\d.]+)pt too (?:wide|high)\)[\w -]*"
    r"|Float too large for page by (?P<float>[\d.]+)pt on input line \d+"
)
GUARDS = re.compile(r"\\(holds|below)\{([^{}]*)\}\s*\{([^{}]*)\}")
DEFINED = re.compile(r"\\csname (.+?)\\endcsname\{(.*)\}\n")  # a line of `evaluation.report.numbers`
log = logging.getLogger(__name__)
NEEDED = {  # file that TeX must find -> Debian package that holds it
    "article.cls": "texlive-latex-base",
    "booktabs.sty": "texlive-latex-recommended",
    "IEEEtran.cls": "texlive-publishers",
    "ptmr7t.tfm": "texlive-fonts-recommended",
}
PACKAGES = ("texlive-latex-recommended", "texlive-publishers", "texlive-fonts-recommended", "latexmk")
TABLES, FIGURES = "tables", "figures"  # folders beside the copy of the paper that TeX reads
NUMBERS, CAPTIONS = "numbers.tex", "captions.tex"  # of the tables: what the text's macros are, and captions with some
PLACES = rf"\def\tables{{{TABLES}}}\def\figures{{{FIGURES}}}\def\results{{{TABLES}}}"
LATEXMK = ("latexmk", "-pdf", "-norc", "-interaction=nonstopmode", "-halt-on-error", f"-usepretex={PLACES}")
UNFIT = "unfit"  # key of the note: what of the text does not fit
LOG_LINES = 15
LINE = "10000"  # characters after which TeX breaks a line of its log
EPOCH = "0"  # date of the PDF unless SOURCE_DATE_EPOCH says another: equal input gives equal bytes


def label_pages(aux: str) -> dict[str, int]:
    """Return label -> page, from 1, of TeX's .aux file."""
    return {found["name"]: int(found["page"]) for found in LABEL.finditer(aux)}


def place_faults(pages: Mapping[str, int], longest: int) -> list[str]:
    """Return what is wrong with the places: a main text of more than `longest` pages, and floats that lie too far."""
    end = pages.get(END)
    if end is None:
        return [f"no label {END!r}, which ends the main text"]
    faults = [f"the main text ends on page {end}; accepted: {longest}"] if end > longest else []
    for name, page in pages.items():
        mentioned = pages.get(f"{FIRST}{name}")
        if mentioned is not None and abs(page - mentioned) > FAR:
            faults.append(f"{name!r} stands on page {page} and is first mentioned on page {mentioned}")
    return faults


def page_faults(log: str) -> list[str]:
    """Return what runs off its page or column by more than OVERFULL_PT [pt], and labels and works that are not there.

    A label that stands twice is a fault, too.

    What is too large is followed by the file of TeX that was read last: the table at fault, unless it is in prose.
    `log` is that of one run, with lines that TeX did not break.
    """
    faults = []
    last = "main file"
    for line in log.splitlines():
        last = next(reversed(INPUT.findall(line)), last)
        if large := LARGE.search(line):
            if float(large["box"] or large["float"]) > OVERFULL_PT:
                faults.append(f"{large[0].strip()} (after {last})")
        elif name := NAMES.search(line):
            faults.append(name[0])
    return list(dict.fromkeys(faults))


def defined_texts(numbers: str) -> dict[str, str]:
    """Return name -> text of what numbers.tex defines."""
    return dict(DEFINED.findall(numbers))


def turned_guards(text: str, numbers: Mapping[str, str]) -> list[str]:
    r"""Return a line for each guard of a TeX text that no longer holds, in the text's order.

    \holds{claim}{verdict,...} holds if the claim's verdict is one of them, \below{cell}{cell} if the first number is
    smaller than the second. `numbers`: what numbers.tex defines.
    """
    lines = []
    for guard, first, second in GUARDS.findall(" ".join(text.split())):
        if guard == "holds":
            now = numbers.get(f"verdict@{first}", "missing")
            wanted = [one.strip() for one in second.split(",")]
            if now not in wanted:
                lines.append(f"claim {first!r} is {now!r}, and the text needs {' or '.join(map(repr, wanted))}")
        else:
            low, high = (numbers.get(f"value@{name}") for name in (first, second))
            if low is None or high is None or float(low) >= float(high):
                lines.append(f"{first!r} is {low}, and the text needs it below {second!r}, which is {high}")
    return list(dict.fromkeys(lines))


class PaperError(MobnetError):
    """TeX is installed but could not set the paper, or its text does not fit its pages or its results."""


def paper(
    scale: str,
    settings: PaperText,
    main: Path,
    references: Path,
    tables: Sequence[Path],
    figures: Sequence[Path],
    out: Path,
) -> None:
    """Set the paper with latexmk, and write a note of it (JSON) also where TeX is missing.

    The note holds the scale, the name of the PDF beside it or null, the missing packages, and what of the text does not
    fit. Tables are TeX files that the paper inputs, figures PDF files. The text's words were chosen for the published
    results of one scale, that of `settings`: results of another seed or processor may turn a guard there, and lengthen
    the main text. That stops no run: a dagger marks the sentence, and `snapshot` refuses such a paper. At another scale
    nothing else can be expected (the verdicts of `smoke` mean nothing). The type of the figures has to be large enough
    at each.

    Raises:
        PaperError: TeX failed, and the message holds the end of its log; or something runs off its page or column, a
            label is defined twice or not at all, or the type of a figure is too small in print, and the message names
            each.
    """
    pdf = out.with_name(f"{main.stem}.pdf")
    missing = missing_packages()
    # A PDF of an earlier run must not pass for one of these tables where TeX fails.
    pdf.unlink(missing_ok=True)
    unfit: list[str] = []
    if missing:
        log.warning("%s: no PDF, TeX is not complete; install: apt-get install %s", pdf, " ".join(PACKAGES))
    else:
        with tempfile.TemporaryDirectory() as folder:
            copy_sources({".": [main, references], TABLES: tables, FIGURES: figures}, Path(folder))
            unfit = set_paper(Path(folder) / main.name, pdf, settings, judged=False)
    note = {"scale": scale, "pdf": None if missing else pdf.name, "missing_packages": missing}
    write_json(out, {**note, UNFIT: unfit if scale == settings.scale else []})


def unfit_words(note: Path) -> list[str]:
    """Return what of the text does not fit its results, as the note of a paper says, if there is one."""
    return list(read_json(note).get(UNFIT, ())) if note.exists() else []


def missing_packages() -> list[str]:
    """Return the Debian packages that are needed and not installed."""
    if shutil.which("latexmk") is None or shutil.which("kpsewhich") is None:
        return list(PACKAGES)
    return [package for name, package in NEEDED.items() if not _found(name)]


def _found(name: str) -> bool:
    """Return whether TeX finds a file."""
    return subprocess.run(["kpsewhich", name], capture_output=True, check=False).returncode == 0


def copy_sources(sources: Mapping[str, Sequence[Path]], folder: Path) -> None:
    """Copy files, which stand by the name of a subfolder, into subfolders of an empty folder.

    Raises:
        DataError: a file is missing.
    """
    for name, paths in sources.items():
        (folder / name).mkdir(exist_ok=True)
        for path in paths:
            if not path.is_file():
                raise DataError(f"{path}: file is missing")
            shutil.copy(path, folder / name)


def set_paper(source: Path, out: Path, settings: PaperText, judged: bool) -> list[str]:
    """Set a copied paper, write its PDF, and return what of its text does not fit its results and its pages.

    Raises:
        PaperError: as of `paper`; where it is `judged`, also for what would be returned.
    """
    text = read_text(source) + read_text(source.parent / TABLES / CAPTIONS)
    turned = turned_guards(text, defined_texts(read_text(source.parent / TABLES / NUMBERS)))
    if judged and turned:
        raise PaperError(f"{out}: the text does not fit its results: {'; '.join(turned)}")
    for line in turned:
        log.info("%s: marked by a dagger: %s", out, line)
    if turned:
        log.warning("%s: %d guarded sentences do not fit these results, a dagger marks each", out, len(turned))
    compile_pdf(source)
    told = _read(source.with_suffix(".log"))
    types = printed_types(told, source.parent)
    for one in types:
        log.info("%s: smallest type in print %.2f pt, drawn at %g pt", one.name, one.printed_pt, one.native_pt)
    faults = [*page_faults(told), *type_faults(types, settings.type_pt)]
    misplaced = place_faults(label_pages(_read(source.with_suffix(".aux"))), settings.pages)
    if judged:
        faults += misplaced
    if faults:
        raise PaperError(f"{out}: the paper does not fit its pages: {'; '.join(faults)}")
    with atomic_path(out) as temporary:
        shutil.copy(source.with_suffix(".pdf"), temporary)
    return [*turned, *misplaced]


def compile_pdf(source: Path) -> None:
    """Run latexmk in the source's folder, which writes its files beside the source."""
    fixed = {"SOURCE_DATE_EPOCH": os.environ.get("SOURCE_DATE_EPOCH", EPOCH), "max_print_line": LINE}
    run = subprocess.run(
        [*LATEXMK, source.name],
        cwd=source.parent,
        capture_output=True,
        text=True,
        errors="replace",
        check=False,
        stdin=subprocess.DEVNULL,
        env={**os.environ, **fixed},
    )
    if run.returncode != 0:
        check_room(source.parent)
        lines = [line for line in run.stdout.splitlines() if line.strip()]
        raise PaperError(f"{source.name}: latexmk ended with {run.returncode}:\n" + "\n".join(lines[-LOG_LINES:]))


def _read(path: Path) -> str:
    return path.read_text(encoding="utf-8", errors="replace")
