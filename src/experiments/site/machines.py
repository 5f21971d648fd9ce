"""The table of docs/cluster.md: how long each scale takes on machines of some kinds, as `./reproduce cost` prices it.

`python -m experiments.site machines` renews it.
"""

import re
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import NamedTuple

from experiments.evaluation.report.compute import HOUR_S
from experiments.evaluation.report.cost import CORES, CORES_WITH_GPU, time_s, with_stacks
from experiments.evaluation.tables.layout import markdown_table
from experiments.plan.dry_run import PlannedJob, dry_run
from experiments.plan.gpu import GPU_RATES, GpuNote, fitted
from experiments.plan.plan import make_plan
from experiments.plan.prices import RATES, RatesNote, priced
from experiments.settings.load import load_settings
from mobnet.core.errors import DataError
from mobnet.core.files import read_text, write_text
from mobnet.core.notes import read_note

PAGE = Path("docs/cluster.md")
BLOCK = re.compile(r"(?<=<!-- machines -->\n).*?(?=<!-- /machines -->)", re.DOTALL)
GPUS_OF_A_CLUSTER, JOBS_OF_A_CLUSTER = 8, 200


class Machine(NamedTuple):
    """A machine or a cluster: its name in the table, its cores and its GPUs."""

    name: str
    cores: int
    gpus: int = 0


MACHINES = (
    Machine("two cores", CORES),
    Machine(f"{CORES_WITH_GPU} cores", CORES_WITH_GPU),
    Machine(f"{CORES_WITH_GPU} cores, one GPU", CORES_WITH_GPU, 1),
    Machine(f"cluster, {JOBS_OF_A_CLUSTER} jobs at once", JOBS_OF_A_CLUSTER),
    Machine(f"the same with {GPUS_OF_A_CLUSTER} GPUs", JOBS_OF_A_CLUSTER, GPUS_OF_A_CLUSTER),
)


@dataclass(frozen=True)
class Asked:
    """What is priced: a target at a scale."""

    scale: str
    target: str = "all"

    @property
    def name(self) -> str:
        """Its name in the table."""
        return f"`{self.scale}`" if self.target == "all" else f"`{self.scale}`, `{self.target}` alone"

    def jobs(self, *, side_by_side: bool) -> list[PlannedJob]:
        """Return its jobs of a run from nothing, with networks that learn side by side or each alone."""
        return dry_run([self.target], [f"scale={self.scale}", stacks_word(side_by_side)], from_nothing=True)


ASKED = (Asked("smoke"), Asked("quick"), Asked("default"), Asked("paper"), Asked("paper", "paper_core"))


def stacks_word(side_by_side: bool) -> str:
    """Return the word of a call by which networks learn side by side, or do not."""
    return with_stacks({"stacks": {"side_by_side": side_by_side}})[1]


def row(asked: Asked, alone: Sequence[PlannedJob], beside: Sequence[PlannedJob], root: Path = Path()) -> list[str]:
    """Return a row of the table: core-hours without a GPU, GPU-hours, and the time on each machine [h].

    Args:
        asked: what is priced.
        alone: its jobs where each network learns alone.
        beside: its jobs where networks learn side by side.
        root: folder of the project.
    """
    rates = read_note(root / RATES, RatesNote)
    gpu = fitted(read_note(root / GPU_RATES, GpuNote))
    settings = load_settings(overrides={"scale": asked.scale, "stacks": {"side_by_side": True}})
    plan = make_plan(settings, with_pdf=False)
    without = load_settings(overrides={"scale": asked.scale, "stacks": {"side_by_side": False}})
    on_cores = priced(make_plan(without, with_pdf=False), rates, None, alone)
    on_gpu = priced(plan, rates, gpu, beside)
    cells = [_hours(job.cpu_s for job in on_cores), _hours(job.gpu_s for job in on_gpu)]
    for machine in MACHINES:
        jobs = on_gpu if machine.gpus else on_cores
        cells.append(_hours([time_s(jobs, machine.cores, machine.gpus)]))
    return [asked.name, *cells]


def _hours(seconds: Iterable[float]) -> str:
    """Return the sum of times in hours, of two significant digits."""
    hours = sum(seconds) / HOUR_S
    return f"{hours:.0f}" if hours >= 10.0 else f"{hours:.1f}" if hours >= 1.0 else f"{hours:.2f}"


def table(rows: Sequence[Sequence[str]]) -> str:
    """Return the table of rows as Markdown."""
    return markdown_table(("scale", "core-hours", "GPU-hours", *(machine.name for machine in MACHINES)), rows)


def block_of(page: str, path: Path = PAGE) -> str:
    """Return the table that a page has.

    Raises:
        DataError: it has none.
    """
    found = BLOCK.search(page)
    if found is None:
        raise DataError(f"{path}: the marks of the table, <!-- machines --> and <!-- /machines -->, are missing")
    return found[0]


def hours_of(page: str, scale: str, path: Path = PAGE) -> tuple[float, float]:
    """Return what the table of a page says of a scale [h]: core-hours without a GPU, and the time on two cores.

    Raises:
        DataError: it says nothing of it.
    """
    for line in block_of(page, path).splitlines():
        name, core_h, _, two_cores_h, *_ = (cell.strip() for cell in line.strip("|").split("|"))
        if name == Asked(scale).name:
            return float(core_h), float(two_cores_h)
    raise DataError(f"{path}: a row of the scale {scale} is missing; `python -m experiments.site machines` makes it")


def renew() -> None:
    """Renew the table of the page."""
    page = read_text(PAGE)
    block_of(page)
    rows: list[list[str]] = []
    for asked in ASKED:
        rows.append(row(asked, asked.jobs(side_by_side=False), asked.jobs(side_by_side=True)))
    write_text(PAGE, BLOCK.sub(lambda _: table(rows), page))
