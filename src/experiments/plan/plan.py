"""The whole plan of a scale: its files, what its jobs get, and its products.

Which number format `learning.precision: auto` stands for is decided once for the results of a scale, and recorded: the
machine that starts the first run decides, by what it takes in each. A training gets the format by its name, so that it
is part of what the training is, and a node of another kind of processor makes the same network.
"""

import shutil
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

from experiments.plan.detection import level_of_detectors
from experiments.plan.files import PLANT, SETS, Files, made_by_jobs
from experiments.plan.heads import CAPTIONS, caption_of
from experiments.plan.items import texts
from experiments.plan.jobs import Jobs
from experiments.plan.product import Call, Context, Folders, Product
from experiments.plan.products import Products, templates
from experiments.plan.reactions import courses_of, is_pushed
from experiments.plan.sets import sets_left
from experiments.plan.trials import trial_products
from experiments.running.words import MAIN
from experiments.settings.catalogue import Catalogue
from experiments.settings.settings import Settings
from mobnet.core.errors import ConfigError, not_accepted
from mobnet.core.files import read_json, write_json
from mobnet.core.notes import Note, checked
from mobnet.learning.precision import AUTO, Precision, in_precision, of_processor

PRECISION = Path("state") / "precision.json"  # below the results of a scale
STACKS = Path("state") / "stacks.json"
ROOT = ("README.md", "CONTRIBUTING.md", "CHANGELOG.md", "CITATION.cff", "SECURITY.md", "paper/README.md")
DOCUMENTS = "docs/**/*.*"
EXAMPLES = "examples/*.*"
# All of them: docstrings and bounds are shown, which the hash of the code leaves out.
MODULES = ("src/mobnet/**/*.py", "src/experiments/**/*.py")
CLAIMS_PAGE = (
    "claims.html",
    "page.html",
    "page.css",
    "page.js",
    "bar.html",
    "claims.css",
    "claims.js",
)  # and its parts


def film_products(files: Files, *, with_mp4: bool) -> Iterator[Product]:
    """Yield the films of the first robot's walks, where robots have detectors; without ffmpeg they are WebP."""
    if not any(level_of_detectors(owner) for owner in files.owners):
        return
    settings = files.settings
    section = settings.evaluation.films
    ending = "mp4" if with_mp4 else "webp"
    outs = {case: files.shared / "films" / f"{case}.{ending}" for case in section.joints}
    courses = courses_of(files, section.joints)
    arguments = {
        "settings": section, "robot": settings.robot, "looks": settings.robot.looks, "obstacles": settings.obstacles,
        "courses": courses, "outs": outs,
    }  # fmt: skip
    call = Call(texts.films, arguments)
    yield Product("films", call, tuple(made_by_jobs(courses)), tuple(map(str, outs.values())))


def documentation(files: Files) -> Iterator[Product]:
    """Yield the pages of the documentation, the same at every scale."""
    modules: list[Path] = []
    for pattern in MODULES:
        modules += _found(pattern)
    given = {
        "documents": [*map(Path, ROOT), *_found(DOCUMENTS), *_found(EXAMPLES)],
        "captions": [*_found(f"{CAPTIONS}/figures/*.rst"), *_found(f"{CAPTIONS}/tables/*.rst")],
        "modules": modules,
        "templates": templates(CLAIMS_PAGE),
    }
    out = files.shared / "docs"
    settings = files.settings
    shared = {"claims": settings.claims, "statistics": settings.evaluation.statistics, "out": out}
    call = Call(texts.docs, {**given, **shared})
    yield Product("docs", call, tuple(made_by_jobs(given)), (str(out),))


def _found(pattern: str) -> list[Path]:
    """Return the files of the project's folder that match a pattern."""
    return sorted(Path().glob(pattern))


@dataclass(frozen=True)
class Plan:
    """What the workflow makes at the chosen scale.

    Of the products, `all` makes the first ones; trials, films and the documentation are made on their own. `tables` and
    `figures` are names of products, `drawn` those of the pictures that figures and drawings write.
    """

    settings: Settings
    folders: Folders
    files: Files
    products: tuple[Product, ...]
    trials: tuple[Product, ...]
    films: tuple[Product, ...]
    docs: tuple[Product, ...]
    tables: tuple[str, ...]
    figures: tuple[str, ...]
    drawn: tuple[str, ...]

    @cached_property
    def jobs(self) -> Jobs:
        """What the jobs of the steps before products get."""
        return Jobs(self.files)

    @property
    def robots(self) -> list[str]:
        """Folders of the plant of section 5.1 and of each robot."""
        return [PLANT, *self.files.robots]

    @property
    def levels(self) -> list[str]:
        """Levels of uncertainty, those of each robot among them."""
        names = dict.fromkeys(self.settings.levels)
        for owner in self.files.owners:
            names |= dict.fromkeys(owner.settings.levels)
        return [*names, *self.settings.fleet.levels]

    @cached_property
    def methods(self) -> list[str]:
        """Methods, and variants of them in sweeps and trials."""
        catalogue = self.files.catalogue
        return [*catalogue.all_methods, *catalogue.tried]

    @property
    def pushed_cases(self) -> list[str]:
        """Cases of reactions in which a robot walks into something, or is pushed."""
        return [case for case in self.settings.reaction.cases if is_pushed(self.files, case)]

    @property
    def free_cases(self) -> list[str]:
        """Cases of reactions in which nothing is in the way."""
        return [case for case in self.settings.reaction.cases if not is_pushed(self.files, case)]

    @cached_property
    def _by_name(self) -> dict[str, Product]:
        every = (*self.products, *self.trials, *self.films, *self.docs)
        return {product.name: product for product in every}

    @property
    def names(self) -> list[str]:
        """Names of all products."""
        return list(self._by_name)

    def product(self, name: str) -> Product:
        """Return a table, a figure or a text by its name.

        Raises:
            ConfigError: there is none.
        """
        if name not in self._by_name:
            raise ConfigError(not_accepted("table, figure or text", name, self._by_name))
        return self._by_name[name]

    @cached_property
    def sets(self) -> list[str]:
        """Files and folders of results that jobs make before products, but those that the configuration lets go."""
        scores = f"{self.folders.results}/scores/"
        names = dict.fromkeys(sets_left(self.files))
        for product in self.products:
            names |= dict.fromkeys(name for name in product.inputs if name.startswith(scores))
        return self.kept(names)

    @property
    def listed(self) -> list[str]:
        """Files of products whose hashes the manifest has: all but its own, and those of a tool with times in them."""
        names: list[str] = []
        for product in self.products:
            if product.name not in ("manifest", "wandb_runs"):
                names += product.outputs
        return names

    def kept(self, outputs: Iterable[str]) -> list[str]:
        """Return outputs of jobs without the sets that are let go once nothing needs them."""
        if self.settings.keep == "all":
            return list(outputs)
        return [output for output in outputs if not set(Path(output).parts) & set(SETS)]

    @property
    def shown(self) -> list[str]:
        """Files of all products."""
        names: list[str] = []
        for product in self._by_name.values():
            names += product.outputs
        return names

    def title(self, figure: str) -> str:
        """Return the first line of a figure's caption, or its name."""
        path = caption_of("figures", figure)
        return path.read_text(encoding="utf-8").partition("\n")[0] if path.is_file() else figure

    def made_by(self, rule: str) -> list[str]:
        """Return the names of the products that a rule makes."""
        trials = {product.name for product in self.trials}
        names: list[str] = []
        for product in self._by_name.values():
            rule_of_product = "trial" if product.name in trials else product.rule
            if rule_of_product == rule:
                names.append(product.name)
        return names


def make_plan(settings: Settings, *, with_pdf: bool, with_mp4: bool | None = None) -> Plan:
    """Return the plan of the chosen scale.

    Without TeX there is no PDF of the paper, and without ffmpeg no film as MP4: None looks for it on this machine.
    """
    if with_mp4 is None:
        with_mp4 = shutil.which("ffmpeg") is not None
    scale = settings.scale
    results = Path("results") / scale
    part = "" if scale == MAIN else scale
    paper, manifest = (Path("paper"), results.parent) if scale == MAIN else (results / "paper", results)
    folders = Folders(results, Path("tables") / part, Path("figures") / part, paper, manifest / "MANIFEST.sha256")
    files = Files(Catalogue(settings), results / PLANT)
    products = Products(Context(settings, files, folders), with_pdf)
    return Plan(
        settings=settings,
        folders=folders,
        files=files,
        products=tuple(products.all()),
        trials=tuple(trial_products(files)),
        films=tuple(film_products(files, with_mp4=with_mp4)),
        docs=tuple(documentation(files)),
        tables=tuple(products.table_names),
        figures=tuple(products.figure_names),
        drawn=tuple(products.drawn),
    )


class StacksNote(Note):
    """The file in which it is recorded whether networks of one shape learn side by side."""

    side_by_side: bool


def with_stacks(settings: Settings, results: Path, gpus: int) -> Settings:
    """Return the settings with a yes or no in place of `auto`: the recorded one, or else whether a GPU is here.

    It is decided once for the results of a scale, as networks that learn side by side get other weights; elsewhere they
    would be trained anew.

    Raises:
        DataError: the record is damaged.
    """
    if settings.stacks.side_by_side != AUTO:
        return settings
    path = results / STACKS
    yes = checked(path, read_json(path), StacksNote).side_by_side if path.exists() else gpus > 0
    return settings.model_copy(update={"stacks": settings.stacks.model_copy(update={"side_by_side": yes})})


def record_stacks(settings: Settings, results: Path) -> None:
    """Record whether networks learn side by side in the results of a scale, if it is not recorded yet."""
    path = results / STACKS
    if not path.exists():
        write_json(path, {"side_by_side": settings.stacks.side_by_side})


class PrecisionNote(Note):
    """The file in which the format is recorded."""

    auto: Precision


def auto_precision(settings: Settings, results: Path, *, is_dry: bool = False) -> Precision | None:
    """Return what `auto` stands for: the recorded format, or else this machine's; None where nothing asks for it.

    Where a scale has no results, every job runs in either format. A dry run then does not try them, which takes
    seconds on a machine that has not done so yet.

    Raises:
        DataError: the record is damaged.
    """
    asked = [settings.learning.precision, *(row.learning.get("precision") for row in settings.methods.values())]
    if AUTO not in asked:
        return None
    if recorded := _recorded_precision(results):
        return recorded
    return "float32" if is_dry and not results.exists() else of_processor()


def with_precision(settings: Settings, name: Precision | None) -> Settings:
    """Return the settings with a number format in place of every `auto`, if there is one."""
    if name is None:
        return settings
    methods = {
        method: row.model_copy(update={"learning": {**row.learning, "precision": name}})
        for method, row in settings.methods.items()
        if row.learning.get("precision") == AUTO
    }
    learning = in_precision(settings.learning, name)
    return settings.model_copy(update={"learning": learning, "methods": {**settings.methods, **methods}})


def record_precision(results: Path, name: Precision | None) -> None:
    """Record what `auto` stands for in the plan of a scale, in its results, if it is asked for and not recorded yet."""
    if name is not None and _recorded_precision(results) is None:
        write_json(results / PRECISION, {"auto": name})


def _recorded_precision(results: Path) -> Precision | None:
    """Return the recorded format, if there is one."""
    path = results / PRECISION
    return checked(path, read_json(path), PrecisionNote).auto if path.exists() else None
