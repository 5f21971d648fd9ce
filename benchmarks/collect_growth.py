"""How time and memory of a collection grow with its length: the full setting, a process of its own for each length.

The slope is of the CPU time, less what a process takes for a second: its start would hide a growth that is too steep.
"""

import sys
import tempfile
from itertools import pairwise
from pathlib import Path

import numpy as np
from benchmarks.jobs import run

from experiments.plan.seeds import FIRST_TRAINING_SEED

SCENARIO, SEED = "random_walk", FIRST_TRAINING_SEED
LENGTHS_S = (60.0, 300.0, 900.0, 3600.0)  # simulated
START_S = 1.0
SLOPE_BAR, MEMORY_BAR_MB, FLAT_BAR = 1.05, 3000.0, 1.1


def main() -> list[dict[str, float | str]]:
    """Return rows of the log-log slopes and of the peaks of memory."""
    with tempfile.TemporaryDirectory() as folder:
        stem = Path(folder) / "recording"
        run("collect", SCENARIO, SEED, START_S, stem)  # compiles the loop if it must
        start = run("collect", SCENARIO, SEED, START_S, stem)
        costs = []
        for length in LENGTHS_S:
            costs.append(run("collect", SCENARIO, SEED, length, stem))
            print(f"{length:g} s: {costs[-1]}", file=sys.stderr, flush=True)
    cpu = [cost.cpu_s - start.cpu_s for cost in costs]
    wall = [cost.wall_s - start.wall_s for cost in costs]
    peaks = [cost.peak_mb for cost in costs]
    rows: list[dict[str, float | str]] = [
        {"name": "growth, log-log slope of CPU time", "ours": slope(cpu), "unit": "-", "at_most": SLOPE_BAR},
        {"name": "growth, log-log slope of wall time", "ours": slope(wall), "unit": "-"},
        {"name": "growth, peak memory", "ours": max(peaks), "unit": "MB", "at_most": MEMORY_BAR_MB},
        {"name": "growth, peak memory, longest over shortest", "ours": peaks[-1] / peaks[0], "unit": "-",
         "at_most": FLAT_BAR},
    ]  # fmt: skip
    for (shorter, a), (longer, b) in pairwise(zip(LENGTHS_S, cpu, strict=True)):
        steps = {"ours": (b - a) / (longer - shorter) * 1e3, "unit": "ms/s"}
        rows.append({"name": f"growth, CPU time of a second more, {shorter:g} s to {longer:g} s", **steps})
    return rows


def slope(times: list[float]) -> float:
    """Return the slope of the line through the logarithms of the times (n,) against those of the lengths [-]."""
    return float(np.polyfit(np.log(LENGTHS_S), np.log(times), 1)[0])


if __name__ == "__main__":
    for row in main():
        print("{name}: {ours:.3f} {unit}".format(**row))
