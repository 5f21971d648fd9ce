"""How much of a random torque is left in the desired torque: the controller takes back what moves its joints.

A step of the random torque by d changes the desired torque by d at once. The joint then moves, its stiffness answers,
and what remains of d some time later is the slope of the desired torque's change over d, by least squares over all
steps. The gait changes the desired torque too, but not with the sign of d, so that it enters the noise alone.
"""

import logging
from collections.abc import Iterator, Sequence
from dataclasses import astuple
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from experiments.evaluation.compare.rmse import Spans
from experiments.evaluation.compare.windows import FLAG
from experiments.evaluation.number.rows import write_csv
from experiments.records.falls import FALLS, Falls
from mobnet.core.arrays import Array
from mobnet.core.columns import DESIRED, FEET, RANDOM, SWING, named
from mobnet.core.errors import SimulationError
from mobnet.core.joints import JointLayout
from mobnet.core.store import read_array
from mobnet.settings.walking import WalkSettings
from mobnet.simulation.record import FALLS_MAX, record
from mobnet.simulation.simulator import Simulator

BEFORE, SETTLED = 2, 1  # samples before a step that must be still, and after it until its mean is the new torque's
STEPS_MIN = 30  # fewer steps say nothing
log = logging.getLogger(__name__)


def torque_left(
    stems: Sequence[Path], layout: JointLayout, limbs: Sequence[str], lags_s: Sequence[float]
) -> Iterator[tuple[str, str, float, str]]:
    """Yield quantity, part, value and unit: the share [-] of a random torque left in the desired torque after lags [s].

    The parts are limbs, means over their joints, and then joints; a joint without enough steps of its torque has none.
    """
    for limb in limbs:
        left: dict[str, Array] = {}
        for joint, step, change in _steps_of(stems, layout, limb, lags_s):
            if len(step) >= STEPS_MIN:
                left[joint] = step @ change / (step @ step)
        parts = {f"limb {limb}": np.mean(list(left.values()), axis=0)} if left else {}
        for part, shares in {**parts, **left}.items():
            for lag, share in zip(lags_s, shares.tolist(), strict=True):
                yield f"random torque left after {1e3 * lag:g} ms", part, share, "-"


def _steps_of(
    stems: Sequence[Path], layout: JointLayout, limb: str, lags_s: Sequence[float]
) -> Iterator[tuple[str, Array, Array]]:
    """Yield each joint of a limb with the steps of its random torque in recordings, (n,) [N m], and what they changed.

    The changes of the desired torque (n, lags) [N m] are those until so long after the step; a leg is in the air
    meanwhile, as a random torque never acts on one that carries load.
    """
    joints = layout.limb(limb)
    feet = [foot for foot in FEET if layout.legs.get(foot.removesuffix("_foot")) == limb]
    stepped: dict[str, list[tuple[Array, Array]]] = {joint: [] for joint in joints}
    for stem in stems:
        array, meta = read_array(stem, [*named(DESIRED, joints), *named(RANDOM, joints), *named(SWING, feet)])
        desired, random, swing = np.split(array.astype(np.float64), [len(joints), 2 * len(joints)], axis=1)
        lags = np.array([round(lag * meta["rate_hz"]) for lag in lags_s])
        air = (swing > FLAG).sum(axis=1) == len(feet)
        for k, joint in enumerate(joints):
            rows = steps_of(random[:, k], air, meta["segments"], int(lags.max()))
            change = desired[rows[:, None] + lags, k] - desired[rows - 1, k][:, None]
            stepped[joint].append((random[rows + SETTLED, k] - random[rows - 1, k], change))
    for joint, parts in stepped.items():
        steps, changes = zip(*parts, strict=True)
        yield joint, np.concatenate(steps), np.concatenate(changes)


def steps_of(random: NDArray[Any], air: NDArray[np.bool_], segments: Spans, after: int) -> NDArray[np.intp]:
    """Return the rows at which a random torque (T,) [N m] steps and is then still for `after` rows, the leg in the air.

    A step within a sample is a mean in that row, so the new torque stands in the next one.
    """
    rows = np.flatnonzero(np.diff(random, prepend=random[:1]) != 0.0)
    inside = np.zeros(len(rows), dtype=bool)
    for first, last in segments:
        inside |= (rows - BEFORE >= first) & (rows + after < last)
    rows = rows[inside]
    moved = np.concatenate([[0], np.cumsum(np.diff(random) != 0.0)])  # changes of the torque up to each row
    grounded = np.concatenate([[0], np.cumsum(~air)])
    still = (moved[rows - 1] == moved[rows - BEFORE]) & (moved[rows + after] == moved[rows + SETTLED])
    return rows[still & (grounded[rows + after + 1] == grounded[rows - BEFORE])]


def count_falls(settings: WalkSettings, seed: int, amplitudes_nm: Sequence[float], walked_s: float, out: Path) -> None:
    """Write the CSV file `out`: falls of the same walk, of `walked_s` [s], with each largest random torque [N m]."""
    rows: list[Falls] = []
    for amplitude in amplitudes_nm:
        rows.append(Falls(settings.level_name, amplitude, walked_s, falls_with(settings, seed, amplitude, walked_s)))
        log.info("%g N m: %d falls in %g s", amplitude, rows[-1].falls, walked_s)
    write_csv(out, FALLS, [astuple(row) for row in rows])


def falls_with(settings: WalkSettings, seed: int, amplitude_nm: float, walked_s: float) -> int:
    """Return the falls in `walked_s` [s] with a largest random torque on legs and waist [N m]; nothing is recorded.

    A robot that cannot walk so ends with FALLS_MAX + 1.
    """
    torque = settings.random_torque.model_copy(update={"legs_waist_nm": amplitude_nm})
    changed = settings.model_copy(update={"random_torque": torque})
    rate_hz = settings.rates.data_hz
    simulator = Simulator(changed, seed)
    samples = round(walked_s * rate_hz)
    try:
        return record(simulator, samples, settings.recording, rate_hz, lambda _: None).falls
    except SimulationError:
        return FALLS_MAX + 1
