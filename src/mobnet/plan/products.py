"""Every table, figure and text: what makes it, what it needs and what it writes."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

from mobnet.plan.call import Job, call_of
from mobnet.plan.needs import NEEDS
from mobnet.plan.runs import ARRAY, COURSE, WEIGHTS, Files, files_in
from mobnet.settings.settings import Settings

EVALUATION = "mobnet.evaluation"
TEMPLATES = Path("src/mobnet/evaluation/report/templates")  # inputs of their rules: the code hash reads Python only
TABLE, FIGURE = ("csv", "tex", "md"), ("pdf", "png", "csv")  # endings of a table's and of a figure's files
TABLES = (
    "table_01",
    "claims",
    "data",
    "steps",
    "coverage",
    "uncertainty",
    "kinds",
    "methods",
    "calibration",
    "error_budget",
)
FIGURES = (
    "figure_05", "figure_06", "figure_07", "figure_08", "figure_09", "figure_10",
    "figure_17", "figure_18", "figure_19", "figure_20", "commands", "calibration",
)  # fmt: skip
BARS = ("figure_06", "figure_10")  # figures whose bars have a CSV of their own


@dataclass(frozen=True)
class Folders:
    """Where a scale's products stand.

    Attributes:
        results: everything but tables, figures and the paper.
        tables: tables.
        figures: figures.
        paper: the paper's PDF.
        manifest: the list of every result with its hash.
    """

    results: Path
    tables: Path
    figures: Path
    paper: Path
    manifest: Path


@dataclass(frozen=True)
class Product:
    """A product of the paper, or of the report around it.

    Attributes:
        name: its name, which is its rule's.
        job: what makes it, and the files that it reads.
        outputs: files that it writes.
    """

    name: str
    job: Job
    outputs: tuple[str, ...]


@dataclass(frozen=True)
class Products:
    """All products at one scale.

    Attributes:
        settings: the configuration.
        files: recordings, networks and runs.
        folders: where products stand.
        with_pdf: whether TeX is there to build the paper's PDF.
    """

    settings: Settings
    files: Files
    folders: Folders
    with_pdf: bool

    @property
    def table_names(self) -> list[str]:
        """Names of all tables."""
        return ["table_01", *self.settings.evaluation.tables, *TABLES[1:]]

    def all(self) -> list[Product]:
        """Return every product, each after those that it needs."""
        shown = [*self._tables(), *self._figures()]
        texts = list(self._texts())
        return [*shown, *texts, *self._report([*shown, *texts])]

    def stored(self) -> list[str]:
        """Return every file that products are made from, also those that could be made again."""
        arrays = [
            self.files.array(kind, *place) for place in self.files.recorded() for kind in ("recordings", "residuals")
        ]
        scenarios = self.settings.tests
        runs = [run for scenario in scenarios for run in self.files.runs_of(scenario)]
        arrays += [run.estimate for run in runs]
        arrays += [stem for scenario, _, seed in self.files.recorded() for stem in self.files.motion(scenario, seed)]
        pairs = [f"{stem}{ending}" for stem in dict.fromkeys(arrays) for ending in (ARRAY, ".json")]
        trained = [f"{folder}/{name}" for folder in self.files.all_networks() for name in (WEIGHTS, *COURSE)]
        fits = dict.fromkeys(str(path) for run in runs for path in self.files.fit(run.method))
        return [*pairs, *trained, *fits, *map(str, self.files.scores(scenarios).values())]

    def _tables(self) -> Iterator[Product]:
        """Yield all tables."""
        for name in self.table_names:
            outputs = [self.folders.tables / f"{name}.{ending}" for ending in TABLE]
            if name in self.settings.evaluation.tables:
                yield self._product(name, f"{EVALUATION}.tables.errors:errors", self._needs(name), outputs)
            elif name != "calibration":
                yield self._product(name, f"{EVALUATION}.tables.{name}:{name}", self._needs(name), outputs)

    def _figures(self) -> Iterator[Product]:
        """Yield all figures."""
        for name in FIGURES:
            outputs = [self.folders.figures / f"{name}.{ending}" for ending in FIGURE]
            outputs += [self.folders.figures / f"{name}_bars.csv"] if name in BARS else []
            outputs += [self.folders.tables / f"{name}.{ending}" for ending in TABLE] if name == "calibration" else []
            floor = "report" if name == "calibration" else "figures"  # its table is made with it
            yield self._product(name, f"{EVALUATION}.{floor}.{name}:{name}", self._needs(name), outputs)

    def _texts(self) -> Iterator[Product]:
        """Yield the numbers and tables that the paper's text takes, and the pages of trainings."""
        tables, results = self.folders.tables, self.folders.results
        csvs = [tables / f"{name}.csv" for name in self.settings.evaluation.tables]
        numbers = {
            "train": self.files.training_size("walk"),
            "table_csvs": csvs,
            "claims_csv": tables / "claims.csv",
        }
        yield self._report_product("numbers", numbers, [tables / "numbers.tex"])
        yield self._report_product("deviations", {"markdown": Path("docs/deviations.md")}, [tables / "deviations.tex"])
        networks = {"folders": self.files.all_networks()}
        parts = [TEMPLATES / f"runs.{ending}" for ending in ("html", "css", "js")]
        yield self._report_product("runs_page", {**networks, "templates": parts}, [results / "runs.html"])
        yield self._report_product("wandb_runs", networks, [results / "wandb"])

    def _report(self, made: list[Product]) -> Iterator[Product]:
        """Yield what looks at all other products: compute, the paper, the pages of the report and the manifest."""
        tables, results, paper = self.folders.tables, self.folders.results, self.folders.paper
        outputs = [Path(name) for product in made for name in product.outputs if product.name != "wandb_runs"]
        accounts = {"accounts": results / "logs", "after": [*map(Path, self.stored()), *outputs]}
        compute = [results / f"compute.{ending}" for ending in TABLE]
        yield self._report_product("compute", accounts, compute)
        texts = [tables / f"{name}.tex" for name in (*self.table_names, "numbers", "deviations")] + [compute[1]]
        sources = {"main": Path("paper/main.tex"), "references": Path("paper/refs.bib"), "tables": texts}
        figures = [self.folders.figures / f"{name}.pdf" for name in FIGURES]
        built = [paper / "build.json", *([paper / "main.pdf"] if self.with_pdf else [])]
        yield self._report_product("paper", {**sources, "figures": figures}, built)
        shown = [*(tables / f"{name}.md" for name in self.table_names), results / "compute.md"]
        captions = [Path(f"workflow/report/tables/{path.stem}.rst") for path in shown]
        pages = [results / "pages" / f"{path.stem}.html" for path in shown]
        needs = {"tables": shown, "captions": captions, "template": TEMPLATES / "table.html"}
        yield self._report_product("pages", needs, pages)
        listed = [*map(Path, self.stored()), *outputs, *compute, *built, *pages]
        yield self._report_product("manifest", {"files": listed}, [self.folders.manifest])

    def _report_product(self, name: str, needs: Mapping[str, object], outputs: list[Path]) -> Product:
        """Return a product of the module of its name in `report`."""
        return self._product(name, f"{EVALUATION}.report.{name}:{name}", needs, outputs)

    def _product(self, name: str, function: str, needs: Mapping[str, object], outputs: list[Path]) -> Product:
        """Return a product; its function gets what its signature names."""
        call = call_of(function, {**self._shared, **self._own(name), **needs, "out": outputs[0]})
        files = dict.fromkeys(str(path) for path in files_in(needs) if str(path) != str(needs.get("accounts")))
        return Product(name, Job(call, tuple(files)), tuple(map(str, outputs)))

    @cached_property
    def _shared(self) -> dict[str, object]:
        """Return what any product may ask for: sections of the configuration, the robot's joints, folders."""
        evaluation = self.settings.evaluation
        return {
            **{name: getattr(self.settings, name) for name in type(self.settings).model_fields if name != "evaluation"},
            **{name: getattr(evaluation, name) for name in ("statistics", "windows", "coverage")},
            "layout": self.settings.layout,
            "sizes": self.settings.sizes,
            "table_dir": self.folders.tables,
            "figure_dir": self.folders.figures,
        }

    def _own(self, name: str) -> dict[str, object]:
        """Return a product's own name, section of the configuration and numbers of the paper."""
        evaluation, published = self.settings.evaluation, self.settings.published
        section = evaluation.tables.get(name) or getattr(evaluation, name, None)
        printed = published.tables.get(name) or getattr(published, name, None)
        own = {"name": name, "settings": section, "published": printed}
        return {key: value for key, value in own.items() if value is not None}

    def _needs(self, name: str) -> Mapping[str, object]:
        """Return scores, runs, recordings or trainings behind a table or a figure."""
        table = self.settings.evaluation.tables.get(name)
        if table is None:
            return NEEDS[name](self.files)
        return {"scores": self.files.scores(dict.fromkeys(row.scenario for row in table.rows))}
