"""Every table, figure and text: what makes it, what it needs and what it writes."""

import functools
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from fnmatch import fnmatch
from pathlib import Path

from experiments.plan.call import Call, call_of, parameters
from experiments.plan.demo import FOLDER, demo_needs, demo_outputs
from experiments.plan.detection import all_detections
from experiments.plan.files import Files, made_by_jobs
from experiments.plan.heads import head_of
from experiments.plan.needs import explore_needs, needs_of
from experiments.plan.project import project_file
from experiments.settings.claims import numbers_of
from experiments.settings.evaluation import ENTRIES, PRODUCTS, Evaluation, row_of
from experiments.settings.products import MadeBy
from experiments.settings.runs import Runs
from experiments.settings.settings import Settings
from mobnet.core.code import ROOT, code_hash

EVALUATION = "experiments.evaluation"
SCRIPT = ROOT / "workflow" / "scripts" / "product.py"  # that makes any product
PAPER = "tables.paper"  # modules of the tables that the paper has
TEMPLATES = Path("src/experiments/evaluation/report/templates")  # inputs of rules: the code hash reads Python only
EXPLORE = (
    "explore.html", "page.html", "explore.css", "explore_data.js", "explore_numbers.js", "explore_pose.js",
    "explore_robot.js", "explore_plots.js", "explore_state.js", "explore.js",
)  # fmt: skip
TABLE, FIGURE = ("csv", "tex", "md"), ("pdf", "svg", "png", "csv")  # endings of a table's and of a figure's files
COUNTED = ("claims_summary", "claims_tolerance", "ten_first")  # tables of what the table of claims holds
STILL = "push"  # the picture beside the film
FILM, DRAWN = ("webp", "gif", "png", "csv"), ("method", "robot")  # endings of the film's files; drawings
TESTS = (  # scenario and level of those whose errors the lists of trainings show, the first that has a network
    "forward_walk/all_uncertainty", "motion_test/all_uncertainty", "walk_test/robots", "hand_wrench/robots",
    "changed_walk/*",
)  # fmt: skip
MAIN_TABLES = ("legs", "limbs", "detectors")  # of the paper's main text, made with its numbers
PAPER_SOURCES = {"main": "paper/main.tex", "references": "paper/refs.bib"}
KEPT_TABLE = Path("docs/trials/factorial")  # a table of a trial that the paper shows and takes numbers from
LOOKED_THROUGH = ("accounts", "results", "beside")  # arguments that are folders, of whatever stands there then
KEPT = "kept"  # parameter of a figure that shows a file of the repository
TIMES = "TIMES.sha256"  # beside the manifest: the list of files that hold times, and so differ between equal runs
CAPTIONS = Path("workflow/report")
HEADINGS = {
    "index.html": "start", "runs.html": "trainings", "explore.html": "explore", "main.pdf": "paper",
    ".html": "tables", ".png": "figures",
}  # fmt: skip
CATEGORIES = {"start": "0 Read me first"}  # the page on which the report opens; the report sorts its categories
HEADLINE = ("table_05", "table_07", "table_10")  # tables of the errors on its first page


@dataclass(frozen=True)
class Folders:
    """Where a scale's products stand; `results` has everything but tables, figures and the paper."""

    results: Path
    tables: Path
    figures: Path
    paper: Path
    manifest: Path

    @property
    def captions(self) -> Path:
        """Folder of the captions of tables and figures in which fields are numbers of this scale."""
        return self.results / "captions"

    def caption(self, written: Path) -> Path:
        """Return the caption with numbers of one as it was written; those of other pages of the report have none."""
        kind = written.parent.name
        return self.captions / kind / written.name if kind in ("tables", "figures") else written


@dataclass(frozen=True)
class Product:
    """A table, a figure, or a part of the paper or report: the files that one job makes, and how it makes them.

    Attributes:
        name: its name.
        call: the call of its function.
        inputs: what it reads.
        outputs: files, or the one folder, that it makes.
        modules: those that the function imports by name only.
    """

    name: str
    call: Call
    inputs: tuple[str, ...]
    outputs: tuple[str, ...]
    modules: tuple[str, ...] = ()

    @property
    def function(self) -> str:
        """Name of its function, `module:name`."""
        return self.call.function

    @property
    def arguments(self) -> dict[str, object]:
        """What the function gets; Snakemake compares a dictionary with that of the last run."""
        return dict(self.call.arguments)

    @property
    def code(self) -> str:
        """Hash of the code behind it."""
        return code_hash(SCRIPT, self.call.module, *self.modules)

    @property
    def heads(self) -> dict[str, str]:
        """Table as Markdown -> what stands above its rows, of those that have a caption."""
        heads: dict[str, str] = {}
        for output in self.outputs:
            caption = caption_of("tables", Path(output).stem)
            if output.endswith(".md") and caption.is_file():
                heads[output] = head_of(caption.read_text(encoding="utf-8"))
        return heads

    @property
    def rule(self) -> str:
        """The rule that makes it: products with files of the same layout share one, others have one of their name."""
        places = [(Path(output).parts[0], Path(output).name) for output in self.outputs]
        drawn = [("figures", f"{self.name}.{ending}") for ending in FIGURE]
        bars = [("figures", f"{self.name}_bars.csv")]
        written = [("tables", f"{self.name}.{ending}") for ending in TABLE]
        layouts = {
            "table": written,
            "figure": drawn,
            "figure_with_bars": [*drawn, *bars],
            "figure_with_table": [*drawn, *written],
        }
        return next((rule for rule, layout in layouts.items() if places == layout), self.name)


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

    settings: Settings
    files: Files
    folders: Folders
    with_pdf: bool

    @property
    def table_names(self) -> list[str]:
        """Names of all tables."""
        own = [name for name, row in _rows().items() if row.table]
        return [*self.settings.evaluation.tables, *own, *MAIN_TABLES]

    @property
    def figure_names(self) -> list[str]:
        """Names of all figures, without those whose source data do not exist yet."""
        own = [name for name, row in _rows().items() if row.figure]
        return [name for name in (*own, *self.settings.evaluation.figures) if self._has_data(name)]

    def _has_data(self, name: str) -> bool:
        """Return whether the file of the repository that a figure shows is there, if it shows one."""
        row = row_of(self.settings.evaluation, name)
        if KEPT not in row.needs:
            return True
        kept = needs_of(self.files, row, self._section(name))[KEPT]
        return not isinstance(kept, Path) or kept.is_file()

    @property
    def drawn(self) -> list[str]:
        """Names of the files of all figures, then of the drawings."""
        names: list[str] = []
        for name in self.figure_names:
            names += pictures(name)
        return [*names, *DRAWN]

    def all(self) -> list[Product]:
        """Return every product, each after those that it needs."""
        made = [*self._tables_and_figures(), self._pictures(), *self._texts()]
        return [*made, *self._report()]

    def _tables_and_figures(self) -> Iterator[Product]:
        """Yield all tables and figures."""
        figures = self.figure_names
        tables = [name for name in self.table_names if name not in MAIN_TABLES]
        for name in dict.fromkeys([*tables, *figures]):
            row = row_of(self.settings.evaluation, name)
            drawn = pictures(name) if name in figures else ()
            outputs = _files(self.folders.figures, drawn, FIGURE)
            outputs += [self.folders.figures / f"{name}_bars.csv"] if row.bars else []
            outputs += [self.folders.tables / f"{name}.{ending}" for ending in TABLE if name in tables]
            function = function_of(self.settings.evaluation, name)
            required, optional = parameters(function)
            needs = needs_of(self.files, row, self._section(name))
            # The row of a field of entries says what any of them may take.
            taken = {key: value for key, value in needs.items() if key in (*required, *optional)}
            yield self._product(name, function, {**taken, **self._tables_of(name)}, outputs)

    def _pictures(self) -> Product:
        """Return the drawings of method and robot, and the film of a push where there is a robot with detectors."""
        figures = self.folders.figures
        evaluation = self.settings.evaluation
        detections = all_detections(self.files)
        story = evaluation.story
        is_told = story.level in detections
        test = Runs(**story.model_dump(include=set(Runs.model_fields)))
        needs: dict[str, object] = {
            "film": evaluation.push_film,
            **{name: getattr(evaluation, name) for name in ("drawings", "story", "peaks")},
            "runs": self.files.first_runs(test) if is_told else (),
            "detections": {story.level: detections[story.level]} if is_told else {},
        }
        outputs = _files(figures, DRAWN, FIGURE)
        outputs += [figures / f"{STILL}.{ending}" for ending in FILM] if is_told else []
        return self._product("pictures", f"{EVALUATION}.figures.further.pictures:pictures", needs, outputs)

    def _tables_of(self, name: str) -> Mapping[str, object]:
        """Return the tables from which another table or figure is made."""
        folder = self.folders.tables
        if name in COUNTED:
            return {"claims_csv": folder / "claims.csv"}
        if name != "claims":
            return {}
        tables: dict[str, Path] = {}
        for claim in self.settings.claims.values():
            for number in numbers_of(claim):
                tables |= {cell.table: folder / f"{cell.table}.csv" for cell in number.cells if cell.table}
        return {"tables": tables}

    def _texts(self) -> Iterator[Product]:
        """Yield numbers and tables that the paper takes, pages of trainings and pushes, and the stored push."""
        tables = self.folders.tables
        results = self.folders.results
        csvs = [tables / f"{name}.csv" for name in self.settings.evaluation.tables]
        made = _files(tables, MAIN_TABLES, TABLE)
        numbers = {
            "train": self.files.training_size("walk"),
            "table_csvs": csvs,
            "further_csvs": [*(tables / f"{name}.csv" for name in quoted()), project_file(f"{KEPT_TABLE}.csv")],
            "captions": self._captions(),
            "compared": self.settings.evaluation.main_tables,
            "sources": [tables / f"{name}.csv" for name in sources(self.settings.evaluation)],
            "claims_csv": tables / "claims.csv",
            "summary_csv": tables / "claims_summary.csv",
        }
        written = [tables / "numbers.tex", tables / "captions.tex", *made, *map(self.folders.caption, self._captions())]
        yield self._report_product("numbers", numbers, written)
        deviations = {"markdown": project_file("docs/deviations.md")}
        yield self._report_product("deviations", deviations, [tables / "deviations.tex"])
        networks = {"folders": self.files.all_networks()}
        names = ("runs.html", "page.html", "page.css", "runs.css", "page.js", "runs.js", "overlay.js")
        parts = templates(names)
        tests: list[tuple[str, str]] = []
        for pattern in TESTS:
            tests += [pair for pair in self.files.scored if fnmatch("/".join(pair), pattern)]
        tested = {**networks, "scores": self.files.scores(tests)}
        yield self._report_product("runs_page", {**tested, "templates": parts}, [results / "runs.html"])
        yield self._report_product("wandb_runs", tested, [results / "wandb"])
        push = demo_needs(self.files)
        yield self._report_product("demo_data", push, [results / FOLDER / name for name in demo_outputs(push)])
        scenes = explore_needs(self.files)
        yield self._report_product("explore", {**scenes, "templates": templates(EXPLORE)}, [results / "explore.html"])

    def _report(self) -> Iterator[Product]:
        """Yield what looks at all other products: compute, the paper, the pages of the report and the manifest."""
        tables = self.folders.tables
        results = self.folders.results
        paper = self.folders.paper
        accounts = {"accounts": results / "logs"}
        compute = [results / f"compute.{ending}" for ending in TABLE]
        yield self._report_product("compute", accounts, compute)
        names = (*self.table_names, "numbers", "captions", "deviations")
        texts = [*(tables / f"{name}.tex" for name in names), compute[1], project_file(f"{KEPT_TABLE}.tex")]
        sources = {name: project_file(path) for name, path in PAPER_SOURCES.items()}
        figures = [self.folders.figures / f"{picture}.pdf" for picture in self.drawn]
        built = [paper / "build.json", *([paper / "main.pdf"] if self.with_pdf else [])]
        yield self._report_product("paper", {**sources, "tables": texts, "figures": figures}, built)
        listed = [*(tables / f"{name}.md" for name in self.table_names), results / "compute.md"]
        pages = [results / "pages" / f"{path.stem}.html" for path in listed]
        told = [found.caption for page in pages if (found := shown(str(page)))]
        captions = [caption and self.folders.caption(caption) for caption in told]
        pages.append(results / "pages" / "index.html")
        yield self._report_product("pages", {"tables": listed, "captions": captions, **self._first_page()}, pages)
        listed = [self.folders.manifest, self.folders.manifest.with_name(TIMES)]
        needs = {"results": results, "beside": [tables, self.folders.figures], "built": built}
        yield self._report_product("manifest", needs, listed)

    def _first_page(self) -> dict[str, object]:
        """Return what the page on which the report opens needs, and the templates of all pages."""
        names = ("page.html", "page.css", "page.js", "bar.html", "index.css", "claims.css", "claims.js")
        parts = templates(names)
        return {
            "pictures": [
                (self.folders.figures / f"{name}.png", self.folders.caption(caption_of("figures", name)))
                for name in self.figure_names
                if row_of(self.settings.evaluation, name).pictured
            ],
            "first": caption_of("start", "index"),
            "templates": {name: project_file(TEMPLATES / f"{name}.html") for name in ("table", "claims", "index")},
            "read": [*parts, *(self.folders.tables / f"{name}.csv" for name in ("claims", *HEADLINE))],
        }

    def _captions(self) -> list[Path]:
        """Return the captions of all tables and figures that have one, for the paper and the report."""
        files = [caption_of("tables", name) for name in (*self.table_names, "compute", KEPT_TABLE.name)]
        files += [caption_of("figures", name) for name in (*self.drawn, STILL)]
        return [path for path in files if path.is_file()]

    def _report_product(self, name: str, needs: Mapping[str, object], outputs: list[Path]) -> Product:
        """Return a product of the module of its name in `report`."""
        return self._product(name, f"{EVALUATION}.report.{name}:{name}", needs, outputs)

    def _product(self, name: str, function: str, needs: Mapping[str, object], outputs: list[Path]) -> Product:
        """Return a product; its function gets what its signature names."""
        call = call_of(function, {**self._shared, **self._own(name), **needs, "out": outputs[0]})
        read = {key: value for key, value in needs.items() if key not in LOOKED_THROUGH}
        return Product(name, call, tuple(made_by_jobs(read)), tuple(map(str, outputs)))

    @functools.cached_property
    def _shared(self) -> dict[str, object]:
        """Return what any product may ask for: sections of the configuration, the robot's joints, folders."""
        evaluation = self.settings.evaluation
        return {
            **{name: getattr(self.settings, name) for name in type(self.settings).model_fields if name != "evaluation"},
            **{name: getattr(evaluation, name) for name in ("statistics", "windows")},
            "layout": self.settings.layout,
            "looks": self.settings.robot.looks,
            "sizes": self.settings.sizes,
            "table_dir": self.folders.tables,
            "figure_dir": self.folders.figures,
            "captions_dir": self.folders.captions,
        }

    def _own(self, name: str) -> dict[str, object]:
        """Return a product's own name, section of the configuration and numbers of the paper, None if it prints none.

        A section may name the table of the paper whose numbers it shows.
        The chosen scale may replace the start of a gait cycle [s] that the section names.
        """
        evaluation = self.settings.evaluation
        published = self.settings.published
        section = self._section(name)
        row = PRODUCTS.get(name, MadeBy(""))
        printed = published.tables.get(getattr(section, "table", name))
        printed = printed or getattr(published, row.published or name, None)
        shortened = self.settings.sizes.figure_start_s
        start_s = getattr(section, "start_s", None) if shortened is None else shortened
        own = {"name": name, "settings": section, "start_s": start_s}
        own = {key: value for key, value in own.items() if value is not None}
        others = {other: getattr(evaluation, other) for other in row.sections}
        return {**own, **others, "published": printed}

    def _section(self, name: str) -> object:
        """Return the section of a product, None if it has none."""
        evaluation = self.settings.evaluation
        return {**evaluation.tables, **evaluation.figures}.get(name) or getattr(evaluation, name, None)


def pictures(name: str) -> tuple[str, ...]:
    """Return the names of the files of a figure: its own, and those of what else it draws."""
    return name, *(PRODUCTS[name].further if name in PRODUCTS else ())


def _files(folder: Path, names: Iterable[str], endings: Iterable[str]) -> list[Path]:
    """Return the files of some names in a folder, one for each ending."""
    found: list[Path] = []
    for name in names:
        found += [folder / f"{name}.{ending}" for ending in endings]
    return found


def templates(names: Iterable[str]) -> list[Path]:
    """Return templates of pages by their names."""
    return [project_file(TEMPLATES / name) for name in names]


def caption_of(kind: str, name: str) -> Path:
    """Return the file of a caption of the project, whether or not it is there."""
    return project_file(CAPTIONS / kind / f"{name}.rst")


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


def function_of(evaluation: Evaluation, name: str) -> str:
    """Return the function `module:name` that makes a table or a figure."""
    return f"{EVALUATION}.{row_of(evaluation, name).function}"


def quoted() -> list[str]:
    """Return the tables that the paper's text takes numbers from, beside those of errors."""
    names = [name for name, row in PRODUCTS.items() if row.quoted]
    return sorted(names, key=lambda name: PRODUCTS[name].quoted)


def sources(evaluation: Evaluation) -> list[str]:
    """Return the tables that those of the paper's main text are made from, those that the paper has first."""
    named = {plant.printed for plant in evaluation.main_tables.legs.plants}
    named.update(line.test.partition("@")[0] for line in evaluation.main_tables.by_limb.lines)
    errors = [name for name in evaluation.tables if name in named]
    own = [name for name, row in PRODUCTS.items() if row.source]
    return [*errors, *sorted(own, key=lambda name: not PRODUCTS[name].function.startswith(PAPER))]


def _rows() -> dict[str, MadeBy]:
    """Return the rows of products, without those that stand for many entries."""
    return {name: row for name, row in PRODUCTS.items() if name not in ENTRIES}
