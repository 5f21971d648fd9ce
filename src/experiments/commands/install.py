"""Packages of environment.lock, each checked by its hash: with uv where it works, else with pip."""

import re
import shutil
from pathlib import Path
from typing import NamedTuple

from experiments.commands.tell import in_gb, is_unreachable, say
from experiments.commands.tools import Tools, failed, written
from mobnet.core.errors import CommandError

# Read by sh: go on in the Python beside this file, without the packages that other software names, as ROS does in every
# shell, and with caches beside the environment, as Snakemake makes one before it reads the Snakefile. Read by Python: a
# text that is not used.
HEADER = """#!/bin/sh
'''unset' PYTHONPATH PYTHONHOME; caches="$(dirname -- "$(realpath -- "$0")")/../../.cache"
export XDG_CACHE_HOME="${XDG_CACHE_HOME:-$caches/xdg}" MPLCONFIGDIR="${MPLCONFIGDIR:-$caches/matplotlib}"
exec "$(dirname -- "$(realpath -- "$0")")/python" "$0" "$@"
' '''
"""
OTHER_HEADERS = re.compile(r"#!.*python.*\n|#!/bin/sh\n'''exec'.*\n' '''\n")
ACTIVATED = """
if [ -n "${PYTHONPATH-}" ]; then
    echo "PYTHONPATH is unset in this shell: its packages must not be mixed with those of .venv" >&2
    unset PYTHONPATH
fi
"""
CONSTRAINTS = "workflow/envs/cuda.constraints"  # what torch's CUDA build requires
UNWANTED = "triton"  # comes with torch's CUDA build, crashes beside Mesa's software renderer, and nothing here uses it


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
INSTALLING = "installing packages"
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


def relocate(venv: Path) -> None:
    """Make an environment's commands and its `activate` find the folder in which they are."""
    for path in (venv / "bin").iterdir():
        with path.open("rb") as handle:
            is_script = handle.read(2) == b"#!"
        if is_script:
            replace(path, OTHER_HEADERS.sub(HEADER.replace("\\", r"\\"), path.read_text(), count=1))
    activate = venv / "bin" / "activate"
    text = activate.read_text().replace(
        '"$SCRIPT_PATH"', '"${SCRIPT_PATH:-.venv/bin/activate}"'
    )  # plain sh knows no path
    replace(activate, text + ACTIVATED)


def replace(path: Path, text: str) -> None:
    """Write a file anew under its name and its mode: a package's file may be shared with uv's cache."""
    mode = path.stat().st_mode
    path.unlink()
    path.write_text(text)
    path.chmod(mode)


def make_venv(tools: Tools) -> None:
    """Make an empty `.venv` that still works after the project's folder was moved or copied."""
    venv = str(tools.root / ".venv")
    tools.run("making .venv", str(tools.uv), "venv", "--quiet", "--relocatable", "--python", tools.base, venv)


def install(tools: Tools, build: str, *, is_asked: bool) -> str:
    """Install the lock with a build of torch; return the build, which is CUDA where nobody offers that for CPUs.

    Raises:
        CommandError: it could not be installed.
    """
    say(INSTALLING)
    outputs = attempt(tools, build)
    if outputs and build == "cpu" and not is_asked and not all(map(is_unreachable, outputs)):
        check_disk(tools.root, "cuda")
        size = in_gb(BUILDS["cuda"].disk)
        say(f"no index offers torch's CPU build for this Python: the CUDA build is taken, {size} in all")
        build = "cuda"
        outputs = attempt(tools, build)
    if outputs:
        raise failed(INSTALLING, next((o for o in outputs if not is_unreachable(o)), outputs[0]))
    tools.try_to(str(tools.uv), "pip", "uninstall", "--quiet", "--python", str(tools.python), UNWANTED)
    relocate(tools.root / ".venv")
    return build


def attempt(tools: Tools, build: str) -> list[str]:
    """Try to install a build from the cache, from pip's places, from where uv knows it, then by pip; return why not."""
    python = str(tools.python)
    places = BUILDS[build].places
    locked = "-r", locked_packages(tools.root, build), "-c", str(tools.root / CONSTRAINTS), "--require-hashes"
    left_out = written(tools.root, "excludes.txt", f"{UNWANTED}\nuv\n")
    compiled = "--compile-bytecode"  # once, instead of at the start of every process that may not write it
    uv = str(tools.uv), "pip", "install", compiled, "--python", python, "--excludes", left_out, *locked
    if any(tools.try_to(*uv, "--offline", *place) is None for place in places):
        return []
    check_disk(tools.root, build)
    outputs: list[str] = []
    pip = *tools.pip, "--python", python, "install", "--disable-pip-version-check", "--retries", "1", *locked
    for words in [*((*uv, *place) for place in places), pip]:
        output = tools.try_to(*words)
        if output is None:
            return []
        outputs.append(output)
    return outputs


def locked_packages(root: Path, build: str) -> str:
    """Write the lock with a build of torch; return the path."""
    text = (root / "environment.lock").read_text()
    versions = BUILDS[build].version
    chosen = re.sub(
        r"^torch==(\S+)", lambda pinned: f"torch{versions.format(version=pinned[1])}", text, flags=re.MULTILINE
    )
    return written(root, f"{build}.txt", chosen)
