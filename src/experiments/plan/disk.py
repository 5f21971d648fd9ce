"""Whether the files that a run is about to write have a place and room, before it starts."""

import shutil
from collections.abc import Iterable
from pathlib import Path

from experiments.plan.files import ARRAY, NOTE
from experiments.plan.plan import Plan
from experiments.settings.catalogue import Catalogue
from mobnet.core.columns import recording_width, residual_columns
from mobnet.core.errors import DataError
from mobnet.core.files import MIB, check_room

NUMBER_BYTES = 4
STORED = 0.6  # of the bytes of an array remain after compression: of recordings 0.46, of residuals 0.54
OTHER_BYTES = MIB // 2  # of a file that is no array: the largest are weights and figures
NOTE_BYTES = MIB // 32  # size of the note of an array


def check_places(plan: Plan) -> None:
    """Check that no folder is where the plan has a file, nor a file where it has a folder.

    Raises:
        DataError: one is.
    """
    names = [*plan.stored]
    for product in plan.products:
        names += product.outputs
    folders: set[Path] = set()
    for path in map(Path, names):
        folders.update(path.parents)
        if path.suffix and path.is_dir():
            raise DataError(f"{path}: a folder is not accepted; accepted: a file, or nothing")
    for folder in folders:
        if folder.exists() and not folder.is_dir():
            raise DataError(f"{folder}: a file is not accepted; accepted: a folder, or nothing")


def check_space(plan: Plan, outputs: Iterable[str]) -> None:
    """Check that files can be written, and that there is room for all of them.

    Raises:
        DataError: a folder cannot be written to, or a disk has less free space than its files will take.
    """
    needed: dict[Path, int] = {}
    # The folder of a file may not be there yet: the nearest one above it that is there tells the disk.
    for path in map(Path, outputs):
        folder = next(folder for folder in path.absolute().parents if folder.is_dir())
        needed[folder] = needed.get(folder, 0) + expected_bytes(plan, path)
    disks: dict[int, list[Path]] = {}
    for folder in needed:
        check_room(folder)
        disks.setdefault(folder.stat().st_dev, []).append(folder)
    for folders in disks.values():
        whole = sum(needed[folder] for folder in folders)
        free = shutil.disk_usage(folders[0]).free
        if free < whole:
            raise DataError(
                f"{min(folders)}: too little space for what the run writes; "
                f"needed: {whole / MIB:,.0f} MiB, free: {free / MIB:,.0f} MiB"
            )


def bytes_of(plan: Plan, names: Iterable[str]) -> int:
    """Return about how many bytes files of a plan will have."""
    return sum(expected_bytes(plan, Path(name)) for name in names)


def expected_bytes(plan: Plan, path: Path) -> int:
    """Return about how many bytes a file of the plan will have: rows by columns for an array."""
    files, (kind, *parts) = plan.files.owner_of(path)
    layout = plan.settings.layout
    match kind if path.suffix == ARRAY else "":
        case "recordings":
            width = recording_width(layout)
        case "residuals":
            level = files.settings.levels[path.parts[-2]]
            width = len(residual_columns(layout, level.labels == "foot_sensors"))
        case "estimates":
            width = _estimated_width(files.catalogue, parts[0], *parts[2:4])
        case _:
            return NOTE_BYTES if path.suffix == NOTE else OTHER_BYTES
    return round(files.array_s(path) * plan.settings.rates.data_hz * width * NUMBER_BYTES * STORED)


def _estimated_width(catalogue: Catalogue, method: str, scenario: str, level: str) -> int:
    """Return the columns of an estimate: a method with networks gives a standard deviation of each joint too."""
    return (1 + bool(catalogue.method(method).limbs)) * len(catalogue.estimated(method, scenario, level))
