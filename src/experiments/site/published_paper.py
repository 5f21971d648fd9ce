"""The paper as PDF from the published results alone, without a run: `./reproduce paper`.

Tables are the TeX files in docs/results, numbers and captions are made from the CSVs there, and so are the figures; one
that shows more than its CSV has, such as the robot's pose, is the picture beside it.
"""

import logging
import sys
import tempfile
from collections.abc import Collection
from pathlib import Path

from experiments.evaluation.figures.style import save_picture
from experiments.evaluation.report.captions import captions_tex, names_in
from experiments.evaluation.report.deviations import deviations
from experiments.evaluation.report.numbers import numbers_tex, size_texts, table_texts, texts_in
from experiments.evaluation.report.paper import (
    CAPTIONS,
    FIGURES,
    NUMBERS,
    PACKAGES,
    TABLES,
    copy_sources,
    missing_packages,
    set_paper,
)
from experiments.plan.heads import CAPTIONS as SOURCES
from experiments.plan.plan import Plan, make_plan
from experiments.plan.products import KEPT_TABLE
from experiments.running.words import paper_parser
from experiments.settings.load import load_settings
from experiments.site.redraw import Stored, drawn_from_csv
from experiments.site.snapshot import SNAPSHOT, run_renewal
from mobnet.core.errors import DataError
from mobnet.core.files import read_text, write_text

log = logging.getLogger(__name__)
MAIN, REFERENCES, DEVIATIONS = Path("paper/main.tex"), Path("paper/refs.bib"), Path("docs/deviations.md")


def published_paper(stored: Stored, out: Path) -> None:
    """Set the paper from published results and write main.pdf into a folder.

    A number that the published results lack, such as one of a table that is newer than they are, is a dash with a
    dagger. Where they lack none, the paper has to pass what that of a run has to.

    Raises:
        DataError: TeX is not complete, or a file is missing or damaged.
        PaperError: the text does not fit its results or its pages.
    """
    if missing_packages():
        raise DataError(f"TeX is not complete; the paper needs: apt-get install {' '.join(PACKAGES)}")
    plan = make_plan(stored.settings, with_pdf=True)
    out.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        copy_sources({".": [MAIN, REFERENCES], TABLES: tables_of(plan, stored.results)}, folder)
        (folder / FIGURES).mkdir()
        shown = draw_figures(stored, plan.drawn, folder / FIGURES)
        log.info("%d figures are drawn or copied; TeX sets the paper", len(shown))
        deviations(DEVIATIONS, folder / TABLES / "deviations.tex")
        absent = write_texts(plan, stored.results, shown, folder)
        if absent:
            told = "%d numbers of the text are not published yet, a dash with a dagger stands for each: %s"
            log.warning(told, len(absent), ", ".join(absent))
        set_paper(folder / MAIN.name, out / "main.pdf", stored.settings.evaluation.paper, judged=not absent)
    log.info("%s", out / "main.pdf")


def tables_of(plan: Plan, results: Path) -> list[Path]:
    """Return the tables of the paper in a folder of published results, and the one of a trial, as TeX."""
    published = [results / f"{name}.tex" for name in (*plan.tables, "compute")]
    return [*published, KEPT_TABLE.with_suffix(".tex")]


def draw_figures(stored: Stored, names: tuple[str, ...], folder: Path) -> set[str]:
    """Draw published figures into a folder as PDF, or copy their picture; return the names of those that there are."""
    known = drawn_from_csv()
    shown: set[str] = set()
    for name in names:
        picture = stored.results / f"{name}.png"
        if not picture.is_file():
            continue
        shown.add(name)
        if name in known:
            save_picture(known[name](stored, name), folder / name, (".pdf",))
        else:
            copy_sources({".": [picture]}, folder)
    return shown


def write_texts(plan: Plan, results: Path, shown: Collection[str], folder: Path) -> list[str]:
    """Write the numbers and captions that the text takes; return the names of the numbers that it lacks."""
    write_text(folder / TABLES / CAPTIONS, captions_tex(captions_of(plan, shown)))
    values = values_in(plan, results)
    asked = names_in(read_text(folder / MAIN.name))
    absent = [name for name in asked if name not in values]
    write_text(folder / TABLES / NUMBERS, numbers_tex(values, absent))
    return absent


def captions_of(plan: Plan, shown: Collection[str]) -> list[Path]:
    """Return the captions of the tables and of the figures that are shown."""
    tables = [SOURCES / TABLES / f"{name}.rst" for name in (*plan.tables, "compute", KEPT_TABLE.name)]
    figures = [SOURCES / FIGURES / f"{name}.rst" for name in plan.drawn if name in shown]
    return [path for path in (*tables, *figures) if path.is_file()]


def values_in(plan: Plan, results: Path) -> dict[str, str]:
    """Return name -> plain text of all numbers that the paper's text may take from published results."""
    settings = plan.settings
    walks = plan.files.training_size("walk")
    sizes = size_texts(settings.scale, settings.rates, settings.sizes, settings.fleet, walks)
    values = {f"size@{name}": text for name, text in sizes.items()}
    return values | table_texts(KEPT_TABLE.with_suffix(".csv")) | texts_in(results)


def main(words: list[str]) -> int:
    """Run the command; return its exit status."""
    options = paper_parser().parse_args(words)
    # Claims that the published tables have no number of are drawn so.
    logging.getLogger("experiments.evaluation.measure.claims").setLevel(logging.ERROR)
    return run_renewal(lambda: published_paper(Stored(SNAPSHOT, load_settings()), options.out), log)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
