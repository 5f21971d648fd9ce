"""The whole plan of a scale: its files, its jobs and its products."""

import shutil
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path

from experiments.plan.call import Call, Job
from experiments.plan.detection import level_of_detectors
from experiments.plan.files import ARRAY, Files, files_in
from experiments.plan.places import MAIN
from experiments.plan.products import CAPTIONS, Folders, Product, Products
from experiments.plan.reactions import courses_of
from experiments.plan.steps import Step, all_steps, trial_steps
from experiments.plan.trials import trial_products
from experiments.plan.work import SECONDS, Work
from experiments.running.logs import LOGS
from experiments.settings.catalogue import Catalogue
from experiments.settings.settings import Settings

ROOT = ("README.md", "CONTRIBUTING.md", "CHANGELOG.md", "CITATION.cff", "paper/README.md")
DOCUMENTS = "docs/**/*.*"
# All of them: docstrings and settings are shown, which the hash of the code leaves out.
MODULES = ("src/mobnet/**/*.py", "src/experiments/**/*.py")
RECORDED = ("recordings", "residuals", "estimates")  # kinds of arrays whose duration says how much there is to do
FOREIGN = "made by another configuration or code, which is not accepted; accepted:"


def film_products(files: Files) -> Iterator[Product]:
    """Yield the films of the first robot's walks, where robots have detectors."""
    if not any(level_of_detectors(own) for own in files.owners):
        return
    settings = files.settings
    section = settings.evaluation.films
    ending = "mp4" if shutil.which("ffmpeg") else "webp"
    outs = {case: files.results / "films" / f"{case}.{ending}" for case in section.joints}
    courses = courses_of(files, section.joints)
    arguments = {
        "settings": section, "robot": settings.robot, "looks": settings.robot.looks, "obstacles": settings.obstacles,
        "courses": courses, "outs": outs,
    }  # fmt: skip
    inputs = tuple(map(str, files_in(courses)))
    job = Job(Call("experiments.evaluation.figures.further.films:films", arguments), inputs)
    yield Product("films", job, tuple(map(str, outs.values())))


def documentation(files: Files) -> Iterator[Product]:
    """Yield the pages of the documentation, the same at every scale."""
    modules: list[Path] = []
    for pattern in MODULES:
        modules += _found(pattern)
    given = {
        "documents": [*map(Path, ROOT), *_found(DOCUMENTS)],
        "captions": [*_found(f"{CAPTIONS}/figures/*.rst"), *_found(f"{CAPTIONS}/tables/*.rst")],
        "modules": modules,
    }
    out = files.results / "docs"
    call = Call("experiments.evaluation.report.docs:docs", {**given, "claims": files.settings.claims, "out": out})
    yield Product("docs", Job(call, tuple(map(str, files_in(given)))), (str(out),))


def _found(pattern: str) -> list[Path]:
    """Return the files of the project's folder that match a pattern."""
    return sorted(Path().glob(pattern))


@dataclass(frozen=True)
class Plan:
    """What the workflow makes at the chosen scale: steps, and products, each after those that it needs.

    The trials are products that are made on their own, by steps of their own; films and the documentation are made on
    their own too, by none.
    """

    settings: Settings
    folders: Folders
    files: Files
    steps: tuple[Step, ...]
    products: tuple[Product, ...]
    trial_steps: tuple[Step, ...]
    trials: tuple[Product, ...]
    films: tuple[Product, ...]
    docs: tuple[Product, ...]

    @property
    def stored(self) -> tuple[str, ...]:
        """Every file that products are made from, also those that could be made again."""
        return tuple(name for step in self.steps for name in step.outputs)

    @property
    def rules(self) -> dict[str, tuple[Work, tuple[str, ...]]]:
        """Rule -> the work of its job, and the files that it makes; not those of the trials."""
        steps = {step.rule: (step.work, step.outputs) for step in self.steps}
        return {**steps, **{product.name: (self._work_of(product), product.outputs) for product in self.products}}

    @property
    def work(self) -> tuple[Work, ...]:
        """The work of every job but the trials'."""
        return tuple(work for work, _ in self.rules.values())

    def _work_of(self, product: Product) -> Work:
        """Return the work of a product: the duration of all recordings, residuals and estimates that it reads [s]."""
        arrays = [path for path in map(Path, product.job.inputs) if path.suffix == ARRAY]
        owned = [(path, *self.files.owner_of(path)) for path in arrays]
        seconds = sum(files.array_s(path) for path, files, (kind, *_) in owned if kind in RECORDED)
        return Work(product.name, product.name, {SECONDS: seconds} if seconds else {}, seconds)


def make_plan(settings: Settings, *, with_pdf: bool) -> Plan:
    """Return the plan of the chosen scale; without TeX there is no PDF of the paper."""
    scale = settings.scale
    results = Path("results") / scale
    part = "" if scale == MAIN else scale
    paper, manifest = (Path("paper"), results.parent) if scale == MAIN else (results / "paper", results)
    folders = Folders(results, Path("tables") / part, Path("figures") / part, paper, manifest / "MANIFEST.sha256")
    files = Files(Catalogue(settings), results)
    steps = tuple(all_steps(files))
    trials = tuple(trial_products(files))
    films = tuple(film_products(files))
    docs = tuple(documentation(files))
    products = Products(settings, files, folders, with_pdf, tuple(name for step in steps for name in step.outputs))
    return Plan(settings, folders, files, steps, tuple(products.all()), tuple(trial_steps(files)), trials, films, docs)


@dataclass(frozen=True)
class Stamped:
    """The files of a plan that have stamps, below the folder of the project."""

    plan: Plan
    root: Path = Path()

    @cached_property
    def steps(self) -> Mapping[str, Step]:
        """File -> the step that makes it."""
        found: dict[str, Step] = {}
        for step in (*self.plan.trial_steps, *self.plan.steps):
            found |= dict.fromkeys(step.outputs, step)
        return found

    @cached_property
    def folders(self) -> frozenset[str]:
        """Folders of results in which every file has a step."""
        return frozenset(map(self._folder, self.steps))

    def foreign(self, names: Iterable[str]) -> Iterator[str]:
        """Yield a line for each file, by its name below the project, that is not what its step makes.

        Tables, figures and what else products make have no stamps, and are left out.
        """
        for name in names:
            step = self.steps.get(name)
            if step is None and self._folder(name) in self.folders:
                yield f"{name}: {FOREIGN} a file that a job of this configuration makes"
            elif step and not step.job.stamps.fit(self.root, self._account(step), name):
                yield f"{name}: {FOREIGN} what `./reproduce {name} --force` makes"

    def _folder(self, name: str) -> str:
        return self.plan.files.owner_of(Path(name))[1][0]

    def _account(self, step: Step) -> str:
        return f"{self.plan.folders.results}/{LOGS}/{step.work.job}.json"
