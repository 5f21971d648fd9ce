"""Every table, figure and text: what makes it, what it needs and what it writes."""

import functools
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from fnmatch import fnmatch
from pathlib import Path

from experiments.plan.demo import FOLDER, demo_needs, demo_outputs
from experiments.plan.detection import all_detections
from experiments.plan.explore import explore_needs
from experiments.plan.files import Files, made_by_jobs
from experiments.plan.heads import caption_of
from experiments.plan.items import claims, detectors, errors, kept, networks, reactions, recordings, texts, walks
from experiments.plan.product import (
    FIGURE,
    PAPER_NOTE,
    TABLE,
    Arguments,
    Call,
    Context,
    Folders,
    Late,
    PaperItem,
    Product,
)
from experiments.plan.project import project_file
from experiments.settings.evaluation import Evaluation
from experiments.settings.runs import Runs
from experiments.settings.settings import Settings
from mobnet.core.errors import ConfigError, not_accepted

FAMILIES = (errors, walks, networks, recordings, detectors, reactions, kept, claims)  # modules of rows
TEMPLATES = Path("src/experiments/evaluation/report/templates")  # inputs of rules: the code hash reads Python only
EXPLORE = (
    "explore.html", "page.html", "explore.css", "explore_data.js", "explore_numbers.js", "explore_pose.js",
    "explore_robot.js", "explore_plots.js", "explore_state.js", "explore.js",
)  # fmt: skip
STILL = "push"  # the picture beside the film
FILM, DRAWN = ("webp", "gif", "png", "csv"), ("method", "robot")  # endings of the film's files; drawings
TESTS = (  # scenario and level of those whose errors the lists of trainings show, the first that has a network
    "forward_walk/all_uncertainty", "motion_test/all_uncertainty", "walk_test/robots", "hand_wrench/robots",
    "changed_walk/*",
)  # fmt: skip
MAIN_TABLES = ("legs", "limbs", "detectors")  # of the paper's main text, made with its numbers
PAPER_SOURCES = {"main": "paper/main.tex", "references": "paper/refs.bib"}
KEPT_TABLE = Path("docs/trials/factorial")  # a table of a trial that the paper shows and takes numbers from
TIMES = "TIMES.sha256"  # beside the manifest: the list of files that hold times, and so differ between equal runs
HEADINGS = {
    "index.html": "start", "runs.html": "trainings", "explore.html": "explore", "main.pdf": "paper",
    ".html": "tables", ".png": "figures",
}  # fmt: skip
CATEGORIES = {"start": "0 Read me first"}  # the page on which the report opens; the report sorts its categories
HEADLINE = ("table_05", "table_07", "table_10")  # tables of the errors on its first page


@dataclass(frozen=True)
class Shown:
    """How the report shows a file: its heading, also the folder of its caption, its title, and its caption."""

    heading: str
    title: str
    caption: Path | None

    @property
    def category(self) -> str:
        """The category of the report."""
        return CATEGORIES.get(self.heading, self.heading.capitalize())


@dataclass(frozen=True)
class Products:
    """All products at one scale; with the paper's PDF only where TeX is there to build it."""

    context: Context
    with_pdf: bool

    @property
    def settings(self) -> Settings:
        """The configuration."""
        return self.context.settings

    @property
    def files(self) -> Files:
        """What stands where."""
        return self.context.files

    @property
    def folders(self) -> Folders:
        """Where products stand."""
        return self.context.folders

    @functools.cached_property
    def items(self) -> list[PaperItem]:
        """The rows of all tables and figures: the tables first, then figures without a table.

        A figure that shows a file of the repository is left out where there is no such file.

        Raises:
            ConfigError: an entry of `figures` has no row.
        """
        tables = [errors.error_table_of(name) for name in self.settings.evaluation.tables]
        figures: list[PaperItem] = []
        for item in all_items():
            if item.table:
                tables.append(item)
            elif not item.kept or self._has_data(item):
                figures.append(item)
        names = [item.name for item in figures]
        for name in self.settings.evaluation.figures:
            if name not in names:
                raise ConfigError(not_accepted("evaluation.figures: figure without a row", name, names))
        return [*tables, *figures]

    def _has_data(self, item: PaperItem) -> bool:
        """Return whether the file of the repository that a figure shows is there."""
        file = item.given(self.context)["kept"]
        return isinstance(file, Path) and file.is_file()

    @property
    def table_names(self) -> list[str]:
        """Names of all tables."""
        return [*(item.name for item in self.items if item.table), *MAIN_TABLES]

    @property
    def _figures(self) -> list[PaperItem]:
        """Rows of all figures, in the order of the configuration."""
        return [item for item in all_items() if item.figure and item in self.items]

    @property
    def figure_names(self) -> list[str]:
        """Names of all figures, without those whose source data do not exist yet."""
        return [item.name for item in self._figures]

    @property
    def drawn(self) -> list[str]:
        """Names of the files of all figures, then of the drawings."""
        names: list[str] = []
        for item in self._figures:
            names += item.pictures
        return [*names, *DRAWN]

    def all(self) -> list[Product]:
        """Return every product, each after those that it needs."""
        made = [*self._tables_and_figures(), self._pictures(), *self._texts()]
        return [*made, *self._report()]

    def _tables_and_figures(self) -> Iterator[Product]:
        """Yield all tables and figures."""
        for item in self.items:
            outputs = _files(self.folders.figures, item.pictures, FIGURE)
            outputs += [self.folders.figures / f"{item.name}_bars.csv"] if item.bars else []
            outputs += _files(self.folders.tables, [item.name] if item.table else [], TABLE)
            given = item.given(self.context)
            call = Call(item.late, {**given, **item.written_into(self.folders)})
            yield Product(item.name, call, tuple(made_by_jobs(given)), tuple(map(str, outputs)))

    def _pictures(self) -> Product:
        """Return the drawings of method and robot, and the film of a push where there is a robot with detectors."""
        figures = self.folders.figures
        evaluation = self.settings.evaluation
        detections = all_detections(self.files)
        story = evaluation.story
        has_detectors = story.level in detections
        test = Runs(**story.model_dump(include=set(Runs.model_fields)))
        needs: dict[str, object] = {
            "film": evaluation.push_film,
            "drawings": evaluation.drawings,
            "story": story,
            "peaks": evaluation.peaks,
            "pushes": self.settings.pushes,
            "robot": self.settings.robot,
            "looks": self.settings.robot.looks,
            "layout": self.context.layout,
            "runs": self.files.first_runs(test) if has_detectors else (),
            "detections": {story.level: detections[story.level]} if has_detectors else {},
        }
        outputs = _files(figures, DRAWN, FIGURE)
        outputs += [figures / f"{STILL}.{ending}" for ending in FILM] if has_detectors else []
        return _product(texts.pictures, needs, outputs, {"figure_dir": figures})

    def _texts(self) -> Iterator[Product]:
        """Yield numbers and tables that the paper takes, pages of trainings and pushes, and the stored push."""
        tables = self.folders.tables
        results = self.folders.results
        csvs = [tables / f"{name}.csv" for name in self.settings.evaluation.tables]
        made = _files(tables, MAIN_TABLES, TABLE)
        numbers: dict[str, object] = {
            "scale": self.settings.scale,
            "rates": self.settings.rates,
            "sizes": self.settings.sizes,
            "fleet": self.settings.fleet,
            "train": self.files.training_size("walk"),
            "table_csvs": csvs,
            "further_csvs": [
                *(tables / f"{name}.csv" for name in names_of(texts.QUOTED)),
                project_file(f"{KEPT_TABLE}.csv"),
            ],
            "captions": self._captions(),
            "compared": self.settings.evaluation.main_tables,
            "sources": [tables / f"{name}.csv" for name in sources(self.settings.evaluation)],
            "claims_csv": tables / "claims.csv",
            "summary_csv": tables / "claims_summary.csv",
        }
        written = [tables / "numbers.tex", tables / "captions.tex", *made, *map(self.folders.caption, self._captions())]
        folders = {"captions_dir": self.folders.captions, "out": written[0]}
        yield _product(texts.numbers, numbers, written, folders)
        deviations = {"markdown": project_file("docs/deviations.md")}
        out = tables / "deviations.tex"
        yield _product(texts.deviations, deviations, [out], {"out": out})
        networks = {"folders": self.files.all_networks()}
        names = ("runs.html", "page.html", "page.css", "runs.css", "page.js", "runs.js", "overlay.js")
        parts = templates(names)
        tests: list[tuple[str, str]] = []
        for pattern in TESTS:
            tests += [pair for pair in self.files.scored if fnmatch("/".join(pair), pattern)]
        tested = {**networks, "scores": self.files.scores(tests)}
        scale = self.settings.scale
        out = results / "runs.html"
        yield _product(texts.runs_page, {**tested, "templates": parts, "scale": scale}, [out], {"out": out})
        out = results / "wandb"
        yield _product(texts.wandb_runs, tested, [out], {"out": out})
        layout = self.context.layout
        push = demo_needs(self.files)
        stored = [results / FOLDER / name for name in demo_outputs(push)]
        yield _product(texts.demo_data, {**push, "scale": scale, "layout": layout}, stored, {"out": stored[0]})
        robot = self.settings.robot
        scenes: dict[str, object] = {
            **explore_needs(self.files),
            "settings": self.settings.evaluation.explore,
            "peaks": self.settings.evaluation.peaks,
            "detection": self.settings.detection,
            "robot": robot,
            "looks": robot.looks,
            "templates": templates(EXPLORE),
        }
        out = results / "explore.html"
        yield _product(texts.explore, scenes, [out], {"out": out})

    def _report(self) -> Iterator[Product]:
        """Yield what looks at all other products: compute, the paper, the pages of the report and the manifest."""
        tables = self.folders.tables
        results = self.folders.results
        paper = self.folders.paper
        compute = [results / f"compute.{ending}" for ending in TABLE]
        # It looks through the accounts of whatever ran, which are no inputs.
        folders = {"accounts": results / "logs", "out": compute[0]}
        yield _product(texts.compute, {"settings": self.settings.evaluation.compute}, compute, folders)
        names = (*self.table_names, "numbers", "captions", "deviations")
        texts_of_tables = [*(tables / f"{name}.tex" for name in names), compute[1], project_file(f"{KEPT_TABLE}.tex")]
        sources = {name: project_file(path) for name, path in PAPER_SOURCES.items()}
        figures = [self.folders.figures / f"{picture}.pdf" for picture in self.drawn]
        built = [paper / PAPER_NOTE, *([paper / "main.pdf"] if self.with_pdf else [])]
        printed: dict[str, object] = {
            **sources,
            "scale": self.settings.scale,
            "settings": self.settings.evaluation.paper,
            "tables": texts_of_tables,
            "figures": figures,
        }
        yield _product(texts.paper, printed, built, {"out": built[0]})
        listed = [*(tables / f"{name}.md" for name in self.table_names), results / "compute.md"]
        pages = [results / "pages" / f"{path.stem}.html" for path in listed]
        written = [how.caption for page in pages if (how := shown(str(page)))]
        captions = [caption and self.folders.caption(caption) for caption in written]
        pages.append(results / "pages" / "index.html")
        shown_tables = {"tables": listed, "captions": captions, "statistics": self.context.statistics}
        folders = {"table_dir": tables, "out": pages[0]}
        yield _product(texts.pages, {**shown_tables, **self._first_page()}, pages, folders, self._read_by_first_page())
        hashes = [self.folders.manifest, self.folders.manifest.with_name(TIMES)]
        # It looks through all that stands in these folders; its rule names what must be there first.
        folders = {"results": results, "beside": [tables, self.folders.figures], "out": hashes[0]}
        yield _product(texts.manifest, {"built": built}, hashes, folders)

    def _first_page(self) -> dict[str, object]:
        """Return what the page on which the report opens shows, and the templates of all pages."""
        figures = [item for item in self._figures if item.late in texts.PICTURED]
        return {
            "pictures": [
                (self.folders.figures / f"{item.name}.png", self.folders.caption(caption_of("figures", item.name)))
                for item in figures
            ],
            "first": caption_of("start", "index"),
            "templates": {name: project_file(TEMPLATES / f"{name}.html") for name in ("table", "claims", "index")},
        }

    def _read_by_first_page(self) -> list[Path]:
        """Return what pages read beside that: templates that are parts of others, and tables by their names."""
        names = ("page.html", "page.css", "page.js", "bar.html", "index.css", "claims.css", "claims.js")
        return [*templates(names), *(self.folders.tables / f"{name}.csv" for name in ("claims", *HEADLINE))]

    def _captions(self) -> list[Path]:
        """Return the captions of all tables and figures that have one, for the paper and the report."""
        files = [caption_of("tables", name) for name in (*self.table_names, "compute", KEPT_TABLE.name)]
        files += [caption_of("figures", name) for name in (*self.drawn, STILL)]
        return [path for path in files if path.is_file()]


def all_items() -> list[PaperItem]:
    """Return the rows of all tables and figures but of tables of errors, in the order of the configuration."""
    items: list[PaperItem] = []
    for family in FAMILIES:
        items += family.ITEMS
    sections = [*Evaluation.model_fields]
    # What has no section of its own, as the claims have none, comes last.
    return sorted(items, key=lambda item: sections.index(item.name) if item.name in sections else len(sections))


def names_of(lates: Iterable[Late]) -> list[str]:
    """Return the names of some tables or figures."""
    names = {item.late: item.name for item in all_items()}
    return [names[late] for late in lates]


def _product(
    late: Late, given: Arguments, outputs: list[Path], folders: Arguments, further: Iterable[Path] = ()
) -> Product:
    """Return a part of the paper or of the report, which has the name of its function.

    Args:
        late: imports its function.
        given: what the function gets; files among it are inputs.
        outputs: what it writes.
        folders: what the function gets beside: where it writes, and folders of whatever stands there then.
        further: inputs that the function finds by itself.
    """
    inputs = made_by_jobs([given, list(further)])
    return Product(late.__name__, Call(late, {**given, **folders}), tuple(inputs), tuple(map(str, outputs)))


def _files(folder: Path, names: Iterable[str], endings: Iterable[str]) -> list[Path]:
    """Return the files of some names in a folder, one for each ending."""
    found: list[Path] = []
    for name in names:
        found += [folder / f"{name}.{ending}" for ending in endings]
    return found


def templates(names: Iterable[str]) -> list[Path]:
    """Return templates of pages by their names."""
    return [project_file(TEMPLATES / name) for name in names]


def shown(file: str) -> Shown | None:
    """Return how the report shows a file; None if it does not."""
    path = Path(file)
    heading = HEADINGS.get(path.name, HEADINGS.get(path.suffix))
    if heading is None:
        return None
    caption = caption_of(heading, path.stem)
    if not caption.is_file():
        return Shown(heading, path.stem, None)
    return Shown(heading, caption.read_text(encoding="utf-8").splitlines()[0], caption)


def sources(evaluation: Evaluation) -> list[str]:
    """Return the tables that those of the paper's main text are made from, those that the paper has first."""
    named = {plant.printed for plant in evaluation.main_tables.legs.plants}
    named.update(line.test.partition("@")[0] for line in evaluation.main_tables.by_limb.lines)
    return [*(name for name in evaluation.tables if name in named), *names_of(texts.SOURCES)]
