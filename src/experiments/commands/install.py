"""Packages of environment.lock, each checked by its hash: with uv where it works, else with pip."""

import re
from pathlib import Path

from experiments.commands.builds import BUILDS, check_disk
from experiments.commands.relocate import relocate
from experiments.commands.tell import in_gb, is_unreachable, say
from experiments.commands.tools import Tools, failed, written

CONSTRAINTS = "workflow/envs/cuda.constraints"  # what torch's CUDA build requires
UNWANTED = "triton"  # comes with torch's CUDA build, crashes beside Mesa's software renderer, and nothing here uses it


def make_venv(tools: Tools) -> None:
    """Make an empty `.venv` that still works after the project's folder was moved or copied."""
    venv = str(tools.root / ".venv")
    tools.run("making .venv", str(tools.uv), "venv", "--quiet", "--relocatable", "--python", tools.base, venv)


def install(tools: Tools, build: str, *, is_asked: bool) -> str:
    """Install the lock with a build of torch; return the build, which is CUDA where nobody offers that for CPUs.

    Raises:
        CommandError: it could not be installed.
    """
    outputs = attempt(tools, build)
    if outputs and build == "cpu" and not is_asked and not all(map(is_unreachable, outputs)):
        check_disk(tools.root, "cuda")
        size = in_gb(BUILDS["cuda"].disk)
        say(f"no index offers torch's CPU build for this Python: the CUDA build is taken, {size} in all")
        build = "cuda"
        outputs = attempt(tools, build)
    if outputs:
        raise failed("installing packages", next((o for o in outputs if not is_unreachable(o)), outputs[0]))
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
    uv = str(tools.uv), "pip", "install", "--quiet", compiled, "--python", python, "--excludes", left_out, *locked
    if any(tools.try_to(*uv, "--offline", *place) is None for place in places):
        return []
    check_disk(tools.root, build)
    outputs: list[str] = []
    pip = *tools.pip, "--python", python, "install", "--quiet", "--disable-pip-version-check", "--retries", "1", *locked
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
        r"^torch==(\S+)", lambda found: f"torch{versions.format(version=found[1])}", text, flags=re.MULTILINE
    )
    return written(root, f"{build}.txt", chosen)
