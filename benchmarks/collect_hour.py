"""An hour of random walking and an hour of random motion, collected side by side on two cores as the workflow would.

`python -m benchmarks.collect_hour [--out FOLDER] [--seconds 600] [--seeds 6] [--sets walk motion]` tells time, disk,
memory, falls, self-collisions, what was commanded and what came of it. Making the motions counts.
"""

import argparse
import sys
import tempfile
import time
from collections.abc import Iterator, Sequence
from concurrent.futures import ThreadPoolExecutor, as_completed
from pathlib import Path
from typing import Any

import numpy as np
from benchmarks.__main__ import Row, misses, table
from benchmarks.jobs import Cost, run

from experiments.evaluation.measure.data.steps import KEYS, UNITS, bin_edges, bin_of, read_steps
from experiments.evaluation.measure.data.upper_body import upper_body
from experiments.evaluation.tables.further.data import commanded
from experiments.plan.seeds import FIRST_TRAINING_SEED
from experiments.settings.load import load_settings
from experiments.settings.settings import Settings
from mobnet.core.columns import COMMAND
from mobnet.core.files import read_json
from mobnet.robot.description import describe
from mobnet.robot.nominal import NominalModel

SETS = {"motion": "random_motion", "walk": "random_walk"}  # the slower one goes first
SEEDS, SECONDS, PROCESSES = 6, 600.0, 2
WALL_BAR_S, DISK_BAR_GB, MEMORY_BAR_MB, FALLS_BAR = 600.0, 4.0, 3000.0, 2.0
LENGTHS = ("step_x", "step_y")  # of Table 2; measured within the tolerance of `evaluation.steps`
GIGABYTE = 1e9


def main(
    out: Path | None = None, seconds: float = SECONDS, seeds: int = SEEDS, sets: Sequence[str] = tuple(SETS)
) -> list[Row]:
    """Collect the sets into `out`, a folder that is removed again if none is named; return a row for each quantity."""
    settings = load_settings()
    with tempfile.TemporaryDirectory() as temporary:
        folder = out or Path(temporary)
        started = time.perf_counter()
        costs = _collect(settings, folder, seconds, seeds, sets)
        wall_s = time.perf_counter() - started
        files = [path for name in sets for path in (folder / name).iterdir()]
        rows: list[Row] = [
            _row("all, wall time", wall_s, "s", at_most=WALL_BAR_S),
            _row(f"all, CPU time over {PROCESSES} processes", sum(c.cpu_s for c in costs) / PROCESSES, "s"),
            _row("all, disk", sum(path.stat().st_size for path in files) / GIGABYTE, "GB", at_most=DISK_BAR_GB),
            _row("all, peak memory of a process", max(c.peak_mb for c in costs), "MB", at_most=MEMORY_BAR_MB),
        ]
        for name in sets:
            rows += _looked_at(settings, name, [_stem(folder, name, k) for k in range(seeds)])
    return rows


def _row(name: str, ours: float, unit: str, **bounds: float) -> Row:
    """Return a row of the table."""
    return {"name": name, "ours": float(ours), "unit": unit, **bounds}


def _stem(folder: Path, name: str, k: int) -> Path:
    """Return where recording k of a set lies."""
    return folder / name / f"s{FIRST_TRAINING_SEED + k}"


def _collect(settings: Settings, folder: Path, seconds: float, seeds: int, sets: Sequence[str]) -> list[Cost]:
    """Make all recordings, two processes at a time; return the cost of each."""
    wanted = [(name, k) for name in SETS if name in sets for k in range(seeds)]
    costs = []
    with ThreadPoolExecutor(PROCESSES) as pool:
        jobs = {
            pool.submit(_shard, settings, name, k, seconds, _stem(folder, name, k)): (name, k) for name, k in wanted
        }
        for done in as_completed(jobs):
            name, k = jobs[done]
            costs += done.result()
            falls = read_json(_stem(folder, name, k).with_suffix(".json"))["falls"]
            took = ", ".join(f"{c.wall_s:.0f} s ({c.cpu_s:.0f} s CPU, {c.peak_mb:.0f} MB)" for c in done.result())
            print(f"{name} {k + 1} of {seeds}: {falls} falls in {seconds:g} s; {took}", file=sys.stderr, flush=True)
    return costs


def _shard(settings: Settings, name: str, k: int, seconds: float, stem: Path) -> list[Cost]:
    """Make one recording and, before it, the motion that it needs; return the cost of both."""
    scenario, seed = SETS[name], FIRST_TRAINING_SEED + k
    stem.parent.mkdir(parents=True, exist_ok=True)
    motion = settings.scenarios[scenario].motion
    if motion is None:
        return [run("collect", scenario, seed, seconds, stem)]
    knots = stem.with_name(f"motion-s{seed}")
    return [run("motion", motion, seed, seconds, knots), run("collect", scenario, seed, seconds, stem, knots)]


def _looked_at(settings: Settings, name: str, stems: list[Path]) -> Iterator[Row]:
    """Yield what a set's recordings hold."""
    notes = [read_json(stem.with_suffix(".json")) for stem in stems]
    hours = sum(note["rows"] / note["rate_hz"] for note in notes) / 3600.0
    yield _row(f"{name}, length", hours, "h")
    yield _row(f"{name}, falls", sum(note["falls"] for note in notes), "", at_most=FALLS_BAR)
    collisions = [note.get("self_collisions", np.nan) for note in notes]  # not looked for: missed
    yield _row(f"{name}, self-collisions", np.sum(collisions), "", at_most=0.0)
    yield _row(f"{name}, least self-clearance", min(note.get("clearance_min_m", np.nan) for note in notes), "m")
    nominal = NominalModel(describe(settings.robot))
    yield from _commands(settings, name, stems, nominal)
    for quantity, part, value, unit in upper_body(settings.evaluation.data.every, stems, nominal):
        if part not in nominal.robot.layout.actuated:
            yield _row(f"{name}, {quantity}, {part}", value, unit)


def _commands(settings: Settings, name: str, stems: list[Path], nominal: NominalModel) -> Iterator[Row]:
    """Yield what was commanded, bins of Table 2 that nothing fell into among it, and the sizes of the steps made."""
    steps, ranges = read_steps(stems, nominal.robot.layout).commanded, settings.commands
    empty = 0
    for column, unit in enumerate(UNITS):
        edges = bin_edges(ranges, column, settings.evaluation.commands.bins)
        counts = np.bincount(bin_of(steps[:, column], edges), minlength=len(edges) - 1).tolist()
        empty += counts.count(0)
        told = f"{name}, {COMMAND[column][0]} [{unit}], {getattr(ranges, KEYS[column])}: steps"
        print(told, *counts, file=sys.stderr, flush=True)
    yield _row(f"{name}, bins of Table 2 never commanded", empty, "", at_most=0.0)
    tolerance = settings.evaluation.steps.tolerance
    within = {"at_least": 1.0 - tolerance, "at_most": 1.0 + tolerance}
    for quantity, part, value, unit in commanded(ranges, settings.walking.foot_spacing_m, stems, nominal):
        bounds = within if quantity == "measured over commanded" and part in LENGTHS else {}
        yield _row(", ".join(filter(None, (name, quantity, part))), value, unit, **bounds)


def _options() -> dict[str, Any]:
    """Return the options of the command line."""
    parser = argparse.ArgumentParser(
        prog="python -m benchmarks.collect_hour", description=(__doc__ or "").split("\n\n")[0]
    )
    parser.add_argument("--out", type=Path, help="folder to keep the recordings in; without one they are removed")
    parser.add_argument("--seconds", type=float, default=SECONDS, help="simulated time a seed")
    parser.add_argument("--seeds", type=int, default=SEEDS, help="recordings a set")
    parser.add_argument("--sets", nargs="+", choices=tuple(SETS), default=tuple(SETS))
    return vars(parser.parse_args())


if __name__ == "__main__":
    found = main(**_options())
    print(table(found))
    sys.exit(any(map(misses, found)))
