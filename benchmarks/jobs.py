"""Motions and recordings, each made in a process of its own as the workflow does, and what they cost.

`run` starts `python -m benchmarks.jobs KIND NAME SEED SECONDS STEM [MOTION_STEM]`, which prints its cost as JSON.
"""

import json
import os
import resource
import subprocess
import sys
import time
from pathlib import Path
from typing import NamedTuple

from experiments.jobs.motions import make_motion
from experiments.plan.jobs import walk_settings
from experiments.settings.load import load_settings
from mobnet.simulation.record import collect

ROOT = Path(__file__).parents[1]
LEVEL = "all_uncertainty"
MEGABYTE = 1 / 1024  # kilobytes, as Linux counts


class Cost(NamedTuple):
    """What a process took, its start included: wall and CPU time [s], most memory [MB]."""

    wall_s: float
    cpu_s: float
    peak_mb: float


def run(kind: str, name: str, seed: int, seconds: float, stem: Path, motion_stem: Path | None = None) -> Cost:
    """Make a `motion` or `collect` a scenario, by name, in one thread of a new process; return its cost.

    Raises:
        CalledProcessError: the process failed; it said why.
    """
    words = [kind, name, str(seed), str(seconds), str(stem.absolute())]
    words += [str(motion_stem.absolute())] if motion_stem else []
    started = time.perf_counter()
    told = subprocess.run(
        [sys.executable, "-m", "benchmarks.jobs", *words],
        cwd=ROOT,
        env={**os.environ, "OMP_NUM_THREADS": "1"},
        stdout=subprocess.PIPE,
        check=True,
    )
    return Cost(time.perf_counter() - started, **json.loads(told.stdout))


def main(kind: str, name: str, seed: str, seconds: str, stem: str, motion_stem: str | None = None) -> None:
    """Do one job in this process and print its cost."""
    settings = load_settings()
    length = int(seed), float(seconds), Path(stem)
    if kind == "motion":
        make_motion(settings.seed, settings.robot, settings.motions[name], name, *length)
    else:
        collect(walk_settings(settings, name, LEVEL), *length, Path(motion_stem) if motion_stem else None)
    used = resource.getrusage(resource.RUSAGE_SELF)
    print(json.dumps({"cpu_s": used.ru_utime + used.ru_stime, "peak_mb": used.ru_maxrss * MEGABYTE}))


if __name__ == "__main__":
    main(*sys.argv[1:])
