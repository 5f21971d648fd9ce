"""The whole plan of a scale: its files, its jobs and its products."""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from mobnet.plan.jobs import Jobs
from mobnet.plan.places import MAIN
from mobnet.plan.products import Folders, Product, Products
from mobnet.plan.runs import Files
from mobnet.plan.trials import trial_products
from mobnet.settings.settings import Settings


@dataclass(frozen=True)
class Plan:
    """What the workflow makes at the chosen scale: products, each after those that it needs, and all that is stored.

    Jobs are those of each robot of the fleet by its name, all others under an empty one. The trials are products that
    are made on their own.
    """

    settings: Settings
    folders: Folders
    files: Files
    jobs: Mapping[str, Jobs]
    products: tuple[Product, ...]
    stored: tuple[str, ...]
    trials: tuple[Product, ...]


def make_plan(settings: Settings, *, with_pdf: bool) -> Plan:
    """Return the plan of the chosen scale; without TeX there is no PDF of the paper."""
    scale = settings.scale
    results, part = Path("results") / scale, "" if scale == MAIN else scale
    paper, manifest = (Path("paper"), results.parent) if scale == MAIN else (results / "paper", results)
    folders = Folders(results, Path("tables") / part, Path("figures") / part, paper, manifest / "MANIFEST.sha256")
    files = Files(settings, results)
    products = Products(settings, files, folders, with_pdf)
    made, trials = tuple(products.all()), tuple(trial_products(settings, files))
    owners = {"": files, **files.robots}
    jobs = {name: Jobs(own.settings, own) for name, own in owners.items()}
    return Plan(settings, folders, files, jobs, made, tuple(products.stored), trials)
