"""When a leg is watched: in its swing by the walking plan, away from both ends, and until the ground is met too early.

The gate knows what a robot knows at the time: the plan's swing and the time until the planned landing, which are sensed
columns, the height of its sole by its joints, and the force on the foot as an estimate of their external torque has it.
"""

from collections.abc import Iterable, Sequence
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from mobnet.core.arrays import Array
from mobnet.core.compilation import compiled
from mobnet.core.machine_code import HeldValue
from mobnet.detection.leg import Leg, foot_load, sole_height
from mobnet.kernel.detecting import GateNumbers

STATE = np.dtype(
    [
        ("air", "i8"),  # samples since the plan lifted the foot off, counted from 1; 0 on the ground
        ("touching", "i8"),  # samples in which the force looked like the ground's, without a gap
        ("landed", "i8"),  # 1 once it did for long enough in this swing
        ("phase", "f8"),  # time since lift-off over that plus the time until landing [-]
    ]
)
IN_THE_AIR = 0.5  # of a flag
Spans = tuple[tuple[int, int], ...]


class Gate(NamedTuple):
    """Numbers of the gate."""

    period: float  # between two samples [s]
    lift_off: int  # samples after lift-off at which it opens
    landing: float  # time before the planned landing at which it closes [s]
    near: float  # time before the planned landing from which on the ground may be met [s]
    low: float  # height of the sole above the other one up to which it may [m]
    force: float  # of an early contact [N]
    upright: float  # least cosine of its angle to the vertical
    hold: int  # samples for which it must last


def make_gate(numbers: GateNumbers, rate_hz: float) -> Gate:
    """Return the gate at a rate of samples [Hz]."""
    # Lift-off is counted in samples and the landing in seconds, since the plan moves the landing within a swing.
    lift_off, hold = (max(1, round(time_s * rate_hz)) for time_s in (numbers.lift_off_s, numbers.contact_s))
    upright = float(np.cos(np.deg2rad(numbers.contact_deg)))
    near = numbers.contact_landing_s
    low = numbers.contact_height_m
    return Gate(1.0 / rate_hz, lift_off, numbers.landing_s, near, low, numbers.contact_n, upright, hold)


def gate_state() -> Any:
    """Return the state of a gate before its first sample, a record of STATE."""
    return np.zeros(1, dtype=STATE).view(np.recarray)[0]


@compiled
def advance_gate(gate: Gate, leg: Leg, s: Any, q: Array, tau: Array, swing: float, landing: float) -> bool:
    """Take one sample; return whether the leg is watched.

    q (nq,) is the generalized position, tau (6,) the estimated external torque of the leg's joints [N m], swing is 1 in
    the air, landing the time until the planned landing [s].
    """
    if swing < IN_THE_AIR:
        s.air = s.touching = s.landed = 0
        s.phase = 0.0
        return False
    # (D4): the plan's own clock. A phase of the measured motion would jump when something stops the leg.
    s.air += 1
    since = s.air * gate.period
    s.phase = since / (since + landing)
    # (D3) [5.3]: only unexpected collisions count. While a foot leaves or meets the ground, ground forces are expected.
    if s.landed == 1 or s.air < gate.lift_off or landing <= gate.landing:
        return False
    # (D6) [7]: a force on the foot inside the friction cone is the ground's where the plan and the pose let the foot
    # meet it; a hit on the shin can have such a force too, but comes higher and earlier. At a straight knee no single
    # wrench explains the torques, and such samples leave the count as it is.
    if landing < gate.near and foot_load(leg, q, tau):
        up = leg.load[2]
        size = np.sqrt(leg.load[0] ** 2 + leg.load[1] ** 2 + leg.load[2] ** 2)
        is_ground = size > gate.force and up > gate.upright * size and sole_height(leg) < gate.low
        s.touching = s.touching + 1 if is_ground else 0
    # An early landing ends the swing, though the plan does not know yet: what follows is the ground, not a collision.
    if s.touching >= gate.hold:
        s.landed = 1
        return False
    return True


@compiled(allocating=True)
def advance_held(holder: HeldValue, s: Any, q: Array, tau: Array, swing: float, landing: float) -> bool:
    """Advance a gate of a leg, which are held together, as `advance_gate` does."""
    gate, leg = holder.value
    return advance_gate(gate, leg, s, q, tau, swing, landing)


@compiled
def run_gate(
    gate: Gate,
    leg: Leg,
    s: Any,
    q: Array,
    tau: Array,
    swing: NDArray[Any],
    landing: NDArray[Any],
    watched: NDArray[np.bool_],
    phase: Array,
) -> None:
    """Run the gate over samples (T, ...) as `advance_gate` does, and write whether it watches and the phase (T,)."""
    for row in range(len(q)):
        watched[row] = advance_gate(gate, leg, s, q[row], tau[row], swing[row], landing[row])
        phase[row] = s.phase


def swings_of(swing: NDArray[Any], segments: Sequence[tuple[int, int]]) -> Spans:
    """Return the rows (start, end) of each whole swing in contiguous segments of the walking plan's swing (T,)."""
    swings: list[tuple[int, int]] = []
    for start, end in segments:
        air = np.asarray(swing[start:end]) > IN_THE_AIR
        edges = np.flatnonzero(np.diff(air)) + 1 + start
        # Half a swing has not had its largest value yet, and would make false alarms look rarer than they are.
        lifted = edges[1:] if len(edges) and air[0] else edges
        swings += [(int(a), int(b)) for a, b in lifted[: len(lifted) // 2 * 2].reshape(-1, 2)]
    return tuple(swings)


def episodes_of(walks: Iterable[tuple[Spans, Spans]]) -> list[int]:
    """Return the contiguous segment of each swing, counted over recordings: their segments and swings in order."""
    segments_of_swings = list[int]()
    before = 0
    for segments, swings in walks:
        segments_of_swings += [before + segment_of(swing, segments) for swing in swings]
        before += len(segments)
    return segments_of_swings


def segment_of(swing: tuple[int, int], segments: Spans) -> int:
    """Return in which of some segments a swing lies."""
    return next(k for k, (_, end) in enumerate(segments) if swing[1] <= end)


def largest(values: NDArray[Any], swings: Sequence[tuple[int, int]]) -> Array:
    """Return the largest numbers (k, ...) of values (T, ...) in each of k swings."""
    shape = (len(swings), *values.shape[1:])
    return np.array([values[start:end].max(axis=0) for start, end in swings], dtype=np.float64).reshape(shape)
