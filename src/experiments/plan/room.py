"""How much room on disk the sets of a job take [MB], and whether a run has it before it starts."""

import shutil
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from experiments.plan.dry_run import PlannedJob
from experiments.plan.files import Files
from experiments.plan.jobs import Jobs
from experiments.plan.schedule import TimedJob, most_held
from mobnet.core.columns import recording_width, residual_columns
from mobnet.core.errors import DataError
from mobnet.core.files import check_room as check_folder

NUMBER_BYTES = 4
STORED = 0.6  # of the bytes of an array remain after compression: of recordings 0.46, of residuals 0.54
MB = 1e6
RESOURCE = "disk_mb"
OTHER_MB = 0.5  # of a file that is in no set: the largest are weights and figures
LET_GO = ("collect", "observe", "estimate")  # rules whose sets go, with `keep: tables`, when nothing needs them
MARGIN = 1.1  # of what these take at once: jobs take other times than they are priced with, and end in another order


@dataclass(frozen=True)
class Sizes:
    """The sizes of sets by the wildcards of the rule that makes them [MB]."""

    jobs: Jobs

    def recordings(self, w: Any) -> int:
        """Return the size of a set of recordings."""
        return self._size(w, recording_width(self.jobs.settings.layout))

    def residuals(self, w: Any) -> int:
        """Return the size of their residuals."""
        level = self.jobs.files(w).settings.levels[w.level]
        return self._size(w, len(residual_columns(self.jobs.settings.layout, level.labels == "foot_sensors")))

    def estimates(self, w: Any) -> int:
        """Return the size of what all methods of a test estimate."""
        files = self.jobs.files(w)
        width = 0
        for method in files.catalogue.tests[w.scenario][w.level]:
            seeds = len(files.run_seeds(method, w.scenario, w.level))
            width += seeds * _estimated_width(files, method, w)
        return self._size(w, width)

    def _size(self, w: Any, width: int) -> int:
        """Return the size of arrays with so many columns, one for each recording of a set."""
        files = self.jobs.files(w)
        rows = files.set_s(w.scenario, w.level) * files.settings.rates.data_hz
        return round(rows * width * NUMBER_BYTES * STORED / MB) + 1


def _estimated_width(files: Files, method: str, w: Any) -> int:
    """Return the columns of an estimate: a method with networks gives a standard deviation of each joint too."""
    catalogue = files.catalogue
    return (1 + bool(catalogue.method(method).limbs)) * len(catalogue.estimated(method, w.scenario, w.level))


def share_at_once(jobs: Sequence[TimedJob], cores: int) -> float:
    """Return the share of what all outputs of a run take that is there at once, where sets are let go."""
    whole_mb = sum(size_mb(timed.job) for timed in jobs)
    most_mb = most_held(jobs, cores, size_mb, lambda job: job.rule in LET_GO)
    return min(1.0, MARGIN * most_mb / whole_mb) if whole_mb else 1.0


def size_mb(job: PlannedJob) -> float:
    """Return what the outputs of a job take [MB]."""
    return float(job.resources.get(RESOURCE, 0)) or OTHER_MB * len(job.outputs)


def check_room(jobs: Iterable[Any], share: float = 1.0) -> None:
    """Check that the outputs of jobs of Snakemake have a place that can be written, and that there is room for them.

    Args:
        jobs: those of a run.
        share: of what they write that is there at once.

    Raises:
        DataError: a file stands where a folder should, a folder cannot be written to, or a disk has too little space.
    """
    needed: dict[Path, float] = {}
    for job in jobs:
        folders = {_nearest(Path(output)) for output in job.output}
        for folder in folders:
            size_mb = job.resources.get(RESOURCE) or OTHER_MB * len(job.output)
            needed[folder] = needed.get(folder, 0.0) + float(size_mb) / len(folders)
    disks: dict[int, list[Path]] = {}
    for folder in needed:
        check_folder(folder)
        disks.setdefault(folder.stat().st_dev, []).append(folder)
    for folders in disks.values():
        whole_mb = share * sum(needed[folder] for folder in folders)
        free_mb = shutil.disk_usage(folders[0]).free / MB
        if free_mb < whole_mb:
            raise DataError(
                f"{min(folders)}: too little space for what the run writes; "
                f"needed: {whole_mb:,.0f} MB, free: {free_mb:,.0f} MB"
            )


def _nearest(output: Path) -> Path:
    """Return the nearest folder above an output that is there.

    Raises:
        DataError: a file stands where a folder should.
    """
    for folder in output.absolute().parents:
        if folder.is_dir():
            return folder
        if folder.exists():
            raise DataError(f"{folder}: a file stands where the run writes a folder; move it away")
    return Path("/")
