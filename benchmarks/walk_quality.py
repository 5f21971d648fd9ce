"""How a walk uses its motors and lands: knees, torque limits, landings, falls, and the observer's errors.

`python -m benchmarks.walk_quality [--scenario random_walk] [--seconds 300] [--seeds 501 502] [--terrain checks ...]`
walks with all uncertainty on seeds of development.
"""

import argparse
import sys
from collections.abc import Iterator, Sequence
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np
from benchmarks.__main__ import Row, misses, table
from numpy.typing import NDArray

from experiments.plan.jobs import walk_settings
from experiments.settings.load import load_settings
from experiments.settings.settings import Settings
from mobnet.core.recording import Recording
from mobnet.core.recording_file import read_recording
from mobnet.estimation.observe import BlockObserver, observer_of
from mobnet.robot.description import RobotDescription, describe
from mobnet.simulation.record import collect

LEVEL, SEEDS, SECONDS = "all_uncertainty", (501, 502), 300.0
PAPER_MOB_NM = np.array([7.73, 24.61, 18.67, 33.60, 17.63, 13.54])  # Table 5, MOB with all uncertainty
KNEE, DRIVE_NM = 3, 250.0  # of a leg's joints; half of 1 / 0.002 N m, the maximum of (23) with Table 4
BEFORE, AFTER = 40, 60  # samples around a planned touch-down in which its largest force is looked for
ROUND_OFF = 1e-6


def main(
    scenario: str = "forward_walk",
    seconds: float = SECONDS,
    seeds: Sequence[int] = SEEDS,
    terrain: Sequence[str] = (),
) -> list[Row]:
    """Walk a scenario, on its own terrains or others; return a row for each quantity."""
    settings = load_settings()
    if terrain:
        walked = settings.scenarios[scenario].model_copy(update={"terrain": tuple(terrain)})
        settings = settings.model_copy(update={"scenarios": {**settings.scenarios, scenario: walked}})
    robot, found = describe(settings.robot), []
    with TemporaryDirectory() as folder:
        for seed in seeds:
            stem = Path(folder) / f"s{seed}"
            collect(walk_settings(settings, scenario, LEVEL), seed, seconds, stem)
            found.append(dict(_measured(settings, robot, read_recording(stem, robot.layout))))
    falls = sum(one.pop("falls") for one in found)
    rows: list[Row] = [{"name": f"{scenario}, falls in {seconds * len(found):g} s", "ours": falls, "unit": ""}]
    rows += [_row(f"{scenario}, {name}", float(np.mean([one[name] for one in found]))) for name in found[0]]
    return rows


def _row(name: str, ours: float) -> Row:
    """Return a row with the bound of the quantity, if it has one."""
    bounds = {"driving": {"at_most": 0.5}, "beyond": {"at_most": 0.0}}
    at = next((bound for word, bound in bounds.items() if word in name), {})
    return {"name": name, "ours": ours, "unit": "%" if at else "", **at}


def _measured(settings: Settings, robot: RobotDescription, recording: Recording) -> Iterator[tuple[str, float]]:
    """Yield name and value of what one recording shows, forces in N, torques in N m, shares in per cent."""
    sensed = recording.sensed
    yield "falls", float(recording.meta["falls"])
    legs = [robot.layout.columns(robot.layout.limb(robot.feet[side].limb)) - 6 for side in ("left", "right")]
    stance = sensed.swing == 0
    knee = sensed.tau_motor[:, [leg[KNEE] for leg in legs]]
    rate = sensed.v[:, [6 + leg[KNEE] for leg in legs]]
    drives = stance & (knee * rate > 0) & (np.abs(knee) > DRIVE_NM)
    yield "stance with the knee driving beyond 250 N m", 100.0 * float(drives.sum() / stance.sum())
    bound = settings.walking.knee_torque_max_nm * (1 - ROUND_OFF)
    yield "stance with the knee at its bound [%]", 100.0 * float((np.abs(knee[stance]) >= bound).mean())
    limits = np.maximum(robot.torque_limits, settings.plant.motor_limit_min_nm) * (1 + ROUND_OFF)
    yield "desired torque beyond a limit", 100.0 * float((np.abs(sensed.tau_des) > limits).any(axis=1).mean())
    for share in (0.5, 0.95, 0.99):
        yield f"knee in stance, quantile {share:g} [N m]", float(np.quantile(np.abs(knee[stance]), share))
    peaks = _landings(recording)
    for share in (0.5, 0.95):
        yield f"landing force, quantile {share:g} [N]", float(np.quantile(peaks, share))
    yield from _errors(settings, robot, recording, legs[0] + 6)


def _errors(
    settings: Settings, robot: RobotDescription, recording: Recording, columns: NDArray[Any]
) -> Iterator[tuple[str, float]]:
    """Yield the observer's errors and the largest torques of the left leg, `columns` (6,) of the velocity [N m]."""
    truth = recording.truth
    gravity, observer = settings.plant.gravity_m_s2, settings.observer
    ratio = settings.levels[LEVEL].nominal_mass_ratio
    momentum = observer_of(robot, ratio, gravity, observer.gain_hz, recording.rate_hz, observer.torque)
    observed = BlockObserver(momentum, recording.segments, recording.rate_hz)
    residual, low_passed = np.split(observed.block(0, recording.sensed, truth.tau_ext, {}), 2, axis=1)
    error = np.sqrt(np.mean((residual - low_passed)[:, columns] ** 2, axis=0))
    for joint, one, most in zip(robot.layout.limb(robot.feet["left"].limb), error, _largest(truth.tau_ext[:, columns]),
                                strict=True):  # fmt: skip
        yield f"MOB {joint} [N m]", float(one)
        yield f"largest external torque {joint} [N m]", float(most)
    yield "MOB mean of the leg [N m]", float(error.mean())
    ratio = error / PAPER_MOB_NM
    yield "MOB worst ratio to the paper [-]", float(np.maximum(ratio, 1 / ratio).max())


def _largest(torque: NDArray[Any]) -> NDArray[Any]:
    """Return the largest size of each column (n,) of torques (T, n)."""
    return np.abs(torque).max(axis=0)


def _landings(recording: Recording) -> list[float]:
    """Return the largest vertical force [N] at each planned touch-down."""
    peaks: list[float] = []
    wrenches = (recording.truth.wrench_left_foot, recording.truth.wrench_right_foot)
    for span in recording.spans():
        for k, wrench in enumerate(wrenches):
            force, swing = wrench[span, 2], recording.sensed.swing[span, k]
            for i in np.flatnonzero(np.diff(swing) < 0):
                if BEFORE <= i < len(force) - AFTER:
                    peaks.append(float(force[i - BEFORE : i + AFTER].max()))
    return peaks


def _options() -> dict[str, Any]:
    """Return the options of the command line."""
    parser = argparse.ArgumentParser(
        prog="python -m benchmarks.walk_quality", description=(__doc__ or "").split("\n\n")[0]
    )
    parser.add_argument("--scenario", default="forward_walk")
    parser.add_argument("--seconds", type=float, default=SECONDS, help="simulated time a seed")
    parser.add_argument("--seeds", type=int, nargs="+", default=SEEDS)
    parser.add_argument("--terrain", nargs="+", default=(), help="terrains in place of the scenario's")
    return vars(parser.parse_args())


if __name__ == "__main__":
    shown = main(**_options())
    print(table(shown))
    sys.exit(any(map(misses, shown)))
