"""The whole plan of a scale: its files, its jobs and its products."""

from dataclasses import dataclass
from pathlib import Path

from experiments.plan.documentation import documentation
from experiments.plan.files import ARRAY, Files
from experiments.plan.films import film_products
from experiments.plan.places import MAIN
from experiments.plan.products import Folders, Product, Products
from experiments.plan.steps import Step, all_steps, trial_steps
from experiments.plan.trials import trial_products
from experiments.plan.work import SECONDS, Work
from experiments.settings.catalogue import Catalogue
from experiments.settings.settings import Settings

RECORDED = ("recordings", "residuals", "estimates")  # kinds of arrays whose duration says how much there is to do


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
