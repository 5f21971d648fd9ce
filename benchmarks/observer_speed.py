"""Speed of the observer: against stepping it sample by sample, against Pinocchio's functions, and with its files.

One thread, processor time, in turns. What is compared moves all joints smoothly: the time does not depend on it. The
whole step `observe` of a recording, which reads, observes and writes, takes a walk of a minute; what a process takes to
start is not in it.
"""

import statistics
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pinocchio as pin
from benchmarks.jobs import run

from experiments.jobs.observing import observe
from experiments.settings.load import load_settings
from experiments.settings.settings import Settings
from mobnet.core.arrays import Array
from mobnet.core.columns import COMMAND, FEET
from mobnet.core.joints import NQ_BASE, JointLayout
from mobnet.core.recording import Sensed
from mobnet.estimation.observe import observer_of
from mobnet.estimation.observer import RobotObserver
from mobnet.kernel.observer import MomentumObserver
from mobnet.robot.description import describe
from mobnet.robot.dynamics import momentum_and_beta
from mobnet.robot.nominal import NominalModel

LEVEL = "all_uncertainty"
SAMPLES, ROUNDS = 5000, 5
WALK, WALK_SEED, WALK_S = "forward_walk", 0, 60.0
OFFLINE_US, STEP_US = 3.0, 12.0  # a sample at most, of a recording at once and of the whole step
ARM_JOINTS, ARM_US = 7, 5.0  # of an arm that is stepped from Python, and a step of it at most
Row = dict[str, float | str]


def main() -> list[Row]:
    """Return rows of microseconds a sample, two with what they are compared with and their ratio over the turns."""
    settings = load_settings()
    robot, rate, observing = describe(settings.robot), settings.rates.data_hz, settings.observer
    level, gravity = settings.levels[LEVEL], settings.plant.gravity_m_s2
    observer = observer_of(robot, level.nominal_mass_ratio, gravity, observing.gain_hz, rate, observing.torque)
    sensed = motion(robot.layout, rate)

    pairs = {
        "observer, a recording at once, against a loop of single samples": (
            lambda: observer.residual(sensed)[-1],
            lambda: _stepped(observer, sensed),
        ),
        "momentum and beta, compiled, against Pinocchio's functions": (
            lambda: np.stack(momentum_and_beta(observer.nominal, sensed.q, sensed.v)),
            lambda: _by_pinocchio(observer.nominal, sensed),
        ),
    }
    offline, compiled = (_row(name, *pair) for name, pair in pairs.items())
    whole: Row = {"name": "observe, reading and writing included", "ours": _whole(settings), "unit": "us/sample"}
    arm: Row = {"name": "a step of an arm of seven joints, from Python", "ours": _arm(), "unit": "us/sample"}
    at_most = {**offline, "at_most": OFFLINE_US}, compiled, {**whole, "at_most": STEP_US}, {**arm, "at_most": ARM_US}
    return list(at_most)


def _arm() -> float:
    """Return the processor time of a step of a fixed arm [us], the median of the turns."""
    model = pin.Model()
    for k in range(ARM_JOINTS):
        model.addJoint(k, pin.JointModelRZ() if k % 2 else pin.JointModelRY(), pin.SE3.Random(), f"J{k + 1}")
        model.appendBodyToJoint(k + 1, pin.Inertia.Random(), pin.SE3.Identity())
    observer = MomentumObserver(model, 1000.0)
    q, v, tau = np.random.default_rng(0).normal(size=(3, ARM_JOINTS))
    state, times = observer.init(), list[float]()
    for _ in range(ROUNDS + 1):
        started = time.process_time()
        for _ in range(SAMPLES):
            state, _ = observer.step(state, q, v, tau)
        times.append(time.process_time() - started)
    return statistics.median(times[1:]) / SAMPLES * 1e6


def _row(name: str, ours: Callable[[], Array], reference: Callable[[], Array]) -> Row:
    """Return microseconds a sample of both, which must return the same numbers, and their ratio over the turns."""
    turns = [_turn(ours, reference) for _ in range(ROUNDS + 1)][1:]
    mine, theirs = (statistics.median(column) / SAMPLES * 1e6 for column in zip(*turns, strict=True))
    ratios = [slow / fast for fast, slow in turns]
    both: Row = {"name": name, "ours": mine, "reference": theirs, "unit": "us/sample"}
    return {**both, "ratio": statistics.median(ratios), "ratio_min": min(ratios)}


def _turn(ours: Callable[[], Array], reference: Callable[[], Array]) -> tuple[float, float]:
    """Return the processor time [s] of both."""
    started = time.process_time()
    found = ours()
    between = time.process_time()
    wanted = reference()
    ended = time.process_time()
    np.testing.assert_allclose(found, wanted, atol=1e-6)
    return between - started, ended - between


def _stepped(observer: RobotObserver, sensed: Sensed) -> Array:
    """Return the last residual of stepping through a recording, (nv,) [N] and [N m]."""
    state, last = observer.init(), np.empty(0)
    for k in range(SAMPLES):
        state, last = observer.step(state, sensed[k])
    return last


def _by_pinocchio(nominal: NominalModel, sensed: Sensed) -> Array:
    """Return p and beta by Pinocchio, (2, SAMPLES, nv): p is rnea(q, 0, v) - g, which is cheaper than M v."""
    model, data, still = nominal.model, nominal.data, np.zeros(nominal.model.nv)
    p, beta = np.empty(sensed.v.shape), np.empty(sensed.v.shape)
    for k, (q, v) in enumerate(zip(nominal.positions(sensed.q), sensed.v, strict=True)):
        load = pin.computeGeneralizedGravity(model, data, q)
        beta[k] = pin.computeCoriolisMatrix(model, data, q, v).T @ v - load
        p[k] = pin.rnea(model, data, q, still, v) - load
    return np.stack([p, beta])


def _whole(settings: Settings) -> float:
    """Return the processor time of the step `observe` of a walk a sample [us], the median of the turns."""
    known = settings.robot, settings.levels[LEVEL], settings.plant.gravity_m_s2, settings.observer
    with tempfile.TemporaryDirectory() as folder:
        walk, out, times = Path(folder) / "walk", Path(folder) / "residual", []
        run("collect", WALK, WALK_SEED, WALK_S, walk)
        for _ in range(ROUNDS + 1):
            started = time.process_time()
            observe(*known, walk, out)
            times.append(time.process_time() - started)
    return statistics.median(times[1:]) / (WALK_S * settings.rates.data_hz) * 1e6


def motion(layout: JointLayout, rate_hz: float) -> Sensed:
    """Return smooth motion of all joints about an upright base, (SAMPLES, ...)."""
    rng = np.random.default_rng(0)
    phase = np.arange(SAMPLES)[:, None] / rate_hz * rng.uniform(1.0, 10.0, layout.nv)
    q, v = np.zeros((SAMPLES, layout.nq)), np.cos(phase)
    q[:, NQ_BASE - 4] = 1.0
    q[:, NQ_BASE:] = np.sin(phase[:, layout.nv - layout.nu :])
    torque: Any = 30.0 * np.sin(phase[:, layout.nv - layout.nu :])
    flags, command = np.zeros((SAMPLES, len(FEET))), np.zeros((SAMPLES, len(COMMAND)))
    return Sensed(q, v, np.zeros((SAMPLES, 3)), torque, torque, flags, command, flags)


if __name__ == "__main__":
    for row in main():
        print("{name}: {ours:.1f} {unit}".format(**row))
