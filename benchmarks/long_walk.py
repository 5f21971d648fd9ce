"""Walk for long and count falls: `python -m benchmarks.long_walk [--seconds 600] [--seeds 1 2 3]`.

Random omnidirectional walking on uneven ground, all uncertainties, base state sensed. A fall ends an episode and the
next begins. A step's error is where the foot stands within 10 ms of touch-down minus where its command put it before
recovery moved the foothold, in the old stance foot's yaw frame, by the sensed kinematics; its duration runs from
touch-down to touch-down.
"""

from __future__ import annotations

import argparse
import sys
import time
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mobnet.core.config import load_config
from mobnet.core.recording import recording_columns, recording_width
from mobnet.simulation.record import Simulator

CONFIG = Path(__file__).parents[1] / "configs" / "config.yaml"
FRAME_S = 0.01  # between two looks at the steps
REPORT_S = 60.0  # simulated, between two lines of progress


def main() -> int:
    """Walk every seed and print a line for each and one for all; return 1 if the robot fell."""
    parser = argparse.ArgumentParser(
        prog="python -m benchmarks.long_walk", description="Walk for long and count falls."
    )
    parser.add_argument("--seconds", type=float, default=600.0, help="simulated time a seed")
    parser.add_argument("--seeds", type=int, nargs="+", default=[1, 2, 3])
    parser.add_argument("--scenario", default="random_walk_plain", help="key of `scenarios` in the configuration")
    parser.add_argument("--level", default="all_uncertainty", help="key of `levels` in the configuration")
    options = parser.parse_args()
    config = load_config(CONFIG)
    _walk(config, options.scenario, options.level, 0, FRAME_S)  # loads or compiles the loop
    falls, steps = 0, []
    for seed in options.seeds:
        started = time.process_time()
        fallen, walked = _walk(config, options.scenario, options.level, seed, options.seconds)
        speed = options.seconds / (time.process_time() - started)
        print(
            f"seed {seed}: {fallen} falls in {options.seconds:g} s, {speed:.1f} x real time; {describe(walked)}",
            flush=True,
        )
        falls, steps = falls + fallen, [*steps, walked]
    total = options.seconds * len(options.seeds)
    print(f"all: {falls} falls in {total:g} s; {describe(np.concatenate(steps))}")
    return int(falls > 0)


def describe(steps: NDArray[np.float64]) -> str:
    """Return one line on steps (n, 4): error forward, left [m], yaw [rad], duration minus the command [s]."""
    if not len(steps):
        return "no step"
    mean, std, worst = steps.mean(axis=0), steps.std(axis=0), np.abs(steps).max(axis=0)
    names = (("x", "mm", 1e3), ("y", "mm", 1e3), ("yaw", "deg", np.degrees(1.0)), ("duration", "ms", 1e3))
    parts = [
        f"{name} {mean[i] * scale:.1f} +- {std[i] * scale:.1f} (worst {worst[i] * scale:.1f}) {unit}"
        for i, (name, unit, scale) in enumerate(names)
    ]
    return f"{len(steps)} steps, error " + ", ".join(parts)


def _walk(
    config: dict[str, Any], scenario: str, level: str, seed: int, seconds: float
) -> tuple[int, NDArray[np.float64]]:
    """Walk one seed; return falls and steps (n, 4) as `describe` takes them."""
    simulator = Simulator(config, scenario, level, seed)
    simulator.start()
    falls, steps, landed = 0, [], -1.0
    samples = round(FRAME_S * config["rates"]["data_hz"])
    rows = np.zeros((samples, recording_width(simulator.robot.layout)), dtype=np.float32)
    for frame in range(round(seconds / FRAME_S)):
        if frame and frame % round(REPORT_S / FRAME_S) == 0:
            print(f"seed {seed}: {frame * FRAME_S:.0f} s, {falls} falls", file=sys.stderr, flush=True)
        before = simulator.state.copy()
        if simulator.run(rows) < len(rows):
            falls, landed = falls + 1, -1.0
            print(f"seed {seed}: fall at {frame * FRAME_S:.2f} s", flush=True)
            simulator.start()
        elif simulator.state.steps > before.steps:
            now = frame * FRAME_S + _touch_down(simulator, rows)
            if landed >= 0.0:
                steps.append([*_error(simulator, before), now - landed - before.commanded])
            landed = now
    return falls, np.array(steps).reshape(-1, 4)


def _touch_down(simulator: Simulator, rows: NDArray[np.float32]) -> float:
    """Return the time [s] in these samples at which the swing ends."""
    columns = recording_columns(simulator.robot.layout)
    first = sum(len(columns[name]) for name in list(columns)[: list(columns).index("swing")])
    swings = rows[:, first : first + 2].any(axis=1)
    return int(np.argmin(swings)) / simulator.config["rates"]["data_hz"]


def _error(simulator: Simulator, before: Any) -> tuple[float, float, float]:
    """Return the new stance foot's error forward, left [m] and in yaw [rad]."""
    walker, period = simulator.walker, simulator.plant.period
    foot = walker.feet[0 if simulator.state.side > 0 else 1]
    error = walker.pose.position[foot, :2] - before.next_ankle
    error -= period * np.round(error / period)  # the robot may have been put back by a period
    rotation, c, s = walker.pose.rotation[foot], np.cos(before.stance_yaw), np.sin(before.stance_yaw)
    turn = np.arctan2(rotation[1, 0], rotation[0, 0]) - before.next_yaw
    turn -= 2 * np.pi * np.round(turn / (2 * np.pi))
    return c * error[0] + s * error[1], c * error[1] - s * error[0], turn


if __name__ == "__main__":
    sys.exit(main())
