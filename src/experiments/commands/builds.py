"""The builds of torch, CPU and CUDA: which of them a machine needs, and what an environment with it takes."""

import shutil
from pathlib import Path
from typing import NamedTuple

from experiments.commands.tell import in_gb
from mobnet.core.errors import CommandError


class Build(NamedTuple):
    """A build: which version of torch it is, where uv finds it besides pip's places, and what set-up takes.

    `disk` in bytes: packages and their cache, which share their files.
    """

    version: str
    places: tuple[tuple[str, ...], ...]
    disk: float
    minutes: str


BUILDS = {  # `===` accepts no other build of the same version
    "cpu": Build("=={version}+cpu", ((), ("--torch-backend=cpu",)), 3.0e9, "1 to 4 minutes"),
    "cuda": Build("==={version}", ((),), 6.4e9, "2 to 7 minutes"),
}
MARGIN = 1.2  # of disk, for files that are only needed while packages are unpacked
MEMORY = "1 GB"  # uv's peak, rounded up


def wanted_build() -> str:
    """Return cuda where a GPU of NVIDIA is seen, else cpu."""
    seen = any(Path("/dev").glob("nvidia[0-9]*")) or Path("/dev/dxg").exists() or shutil.which("nvidia-smi")
    return "cuda" if seen else "cpu"


def check_disk(root: Path, build: str) -> None:
    """Raise CommandError where the disk has no room for an environment.

    Raises:
        CommandError: needed and free space.
    """
    needed = BUILDS[build].disk * MARGIN
    free = shutil.disk_usage(root).free
    if free < needed:
        raise CommandError(f"{root}: {in_gb(free)} free, {in_gb(needed)} needed while packages are unpacked; make room")


def costs(root: Path, build: str, *, is_asked: bool) -> str:
    """Return what a set-up takes; nobody has asked yet whether an index offers the build for CPUs."""
    free = in_gb(shutil.disk_usage(root).free)
    disk = in_gb(BUILDS[build].disk)
    minutes = BUILDS[build].minutes
    if build == "cpu" and not is_asked:
        disk += f" of disk, or {in_gb(BUILDS['cuda'].disk)} where no index offers torch's CPU build"
        return f"{disk} ({free} free), {MEMORY} of memory and {minutes}"
    return f"{disk} of disk ({free} free), {MEMORY} of memory and {minutes}"
