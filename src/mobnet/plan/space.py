"""Whether the disks have room for what a run is about to write."""

import shutil
from collections.abc import Iterable
from pathlib import Path

from mobnet.core.columns import recording_width, residual_columns
from mobnet.core.errors import DataError
from mobnet.core.files import MIB
from mobnet.plan.plan import Plan
from mobnet.plan.runs import ARRAY

NUMBER_BYTES = 4
STORED = 0.85  # of the bytes of a recording remain after compression, of other arrays less
OTHER_BYTES = MIB // 2  # of a file that is no array: the largest are weights and figures


def check_space(plan: Plan, outputs: Iterable[str]) -> None:
    """Check that there is room for files that are about to be written.

    Raises:
        DataError: a disk has less free space than its files will take.
    """
    needed: dict[int, int] = {}
    places: dict[int, Path] = {}
    for name in outputs:
        place = next(folder for folder in Path(name).absolute().parents if folder.is_dir())
        disk = place.stat().st_dev
        places.setdefault(disk, place)
        needed[disk] = needed.get(disk, 0) + expected_bytes(plan, Path(name))
    for disk, place in places.items():
        free = shutil.disk_usage(place).free
        if free < needed[disk]:
            raise DataError(
                f"{place}: too little space for what the run writes there; "
                f"needed: {needed[disk] / MIB:,.0f} MiB, free: {free / MIB:,.0f} MiB"
            )


def expected_bytes(plan: Plan, path: Path) -> int:
    """Return about how many bytes a file of the plan will have: rows by columns for an array."""
    layout, of_residual = plan.settings.layout, len(residual_columns(plan.settings.layout))
    widths = {"recordings": recording_width(layout), "residuals": of_residual, "estimates": of_residual}
    kind = path.relative_to(plan.folders.results).parts[0] if path.is_relative_to(plan.folders.results) else ""
    if path.suffix != ARRAY or kind not in widths:
        return OTHER_BYTES
    duration_s = plan.files.duration_s([path.parts[-3]], int(path.stem.removeprefix("s")))
    return round(duration_s * plan.settings.rates.data_hz * widths[kind] * NUMBER_BYTES * STORED)
