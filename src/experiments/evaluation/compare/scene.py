"""What a recording tells of a walk beside the estimates of it: the raw truth, pushes, phases of the gait, speeds."""

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from experiments.evaluation.compare.pair import Pair
from experiments.evaluation.compare.windows import FLAG
from experiments.settings.measures import Scoring
from mobnet.core.columns import CONTACT, EXTERNAL, FEET, PUSH_TORQUE, PUSHED, SWING, VELOCITY, foot_of, named
from mobnet.core.joints import JointLayout
from mobnet.core.notes import read_array_note
from mobnet.core.store import NOTE, file_of, read_array
from mobnet.kernel.low_pass import low_pass

SWINGING, TOUCH_DOWN, STANCE = "swing", "touch_down", "stance"  # phases of a leg


@dataclass(frozen=True)
class Scene:
    """A recording, and what is asked of it; each property reads its columns once."""

    stem: Path
    layout: JointLayout
    asked: Scoring

    @cached_property
    def external(self) -> NDArray[np.float32]:
        """The raw truth, `tau_ext` of all joints (T, nv) [N m], V1..V3 [N]."""
        return self._read(named(EXTERNAL, self.layout.names))

    @cached_property
    def pushes(self) -> NDArray[np.float32]:
        """What pushes alone add to it (T, nv) [N m], V1..V3 [N]."""
        return self._read(named(PUSH_TORQUE, self.layout.names))

    @cached_property
    def pushed(self) -> NDArray[np.bool_]:
        """Whether a push acts (T,)."""
        return self._read([PUSHED])[:, 0] > FLAG

    @cached_property
    def speed(self) -> NDArray[np.float32]:
        """Absolute velocity of all joints (T, nv) [rad/s]; nan of the virtual ones, which nothing rubs."""
        measured = np.abs(self._read(named(VELOCITY, self.layout.actuated)))
        return np.pad(measured, ((0, 0), (self.layout.nv - self.layout.nu, 0)), constant_values=np.nan)

    @cached_property
    def phases(self) -> dict[str, NDArray[np.bool_]]:
        """Phase -> whether each joint's own leg is in it (T, nv); a joint of no leg is in none."""
        note = read_array_note(file_of(self.stem, NOTE))
        rows = round(self.asked.touch_down_s * note["rate_hz"])
        spans = note["segments"]
        by_phase = {
            name: np.zeros((note["rows"], self.layout.nv), dtype=bool) for name in (SWINGING, TOUCH_DOWN, STANCE)
        }
        for side, limb in self.layout.legs.items():
            foot = next(name for name in FEET if name.startswith(side))
            swing, contact = (self._read([f"{signal}.{foot}"])[:, 0] > FLAG for signal in (SWING, CONTACT))
            for name, mask in gait_phases(swing, contact, spans, rows).items():
                by_phase[name][:, self.layout.columns(self.layout.limb(limb))] = mask[:, None]
        return by_phase

    def planned(self, joint: str) -> NDArray[np.bool_]:
        """Return whether the walking plan has the foot of a joint's own leg in the air (T,)."""
        return self._read([f"{SWING}.{foot_of(self.layout, joint)}"])[:, 0] > FLAG

    def behind(self, gain_hz: float, joints: Sequence[str]) -> NDArray[np.float64]:
        """Return pushes on joints behind the observer's low-pass, (T, n) [N m], V1..V3 [N]; the gain is K_0 [1/s]."""
        note = read_array_note(file_of(self.stem, NOTE))
        push = self.pushes[:, self.layout.columns(joints)]
        behind = np.zeros(push.shape)
        # Each segment on its own: rows of two of them do not follow each other in time.
        for start, end in note["segments"]:
            behind[start:end] = low_pass(push[start:end], gain_hz, note["rate_hz"])
        return behind

    def _read(self, names: list[str]) -> NDArray[np.float32]:
        return read_array(self.stem, names)[0]


def gait_phases(
    swing: NDArray[np.bool_], contact: NDArray[np.bool_], spans: Iterable[Iterable[int]], touch_down: int
) -> dict[str, NDArray[np.bool_]]:
    """Return phase -> whether a leg is in it (T,): swing, touch-down or stance, always one of them.

    A touch-down is the first `touch_down` rows from a contact on that follows as many rows without contact, within a
    span (start, end); swing is what else the plan has in the air and touches nothing, stance is all other time.
    """
    landing = np.zeros(len(contact), dtype=bool)
    for start, end in spans:
        touched = np.flatnonzero(contact[start:end])
        first = touched[np.diff(touched, prepend=-1) > touch_down]
        for row in start + first:
            landing[row : min(row + touch_down, end)] = True
    air = swing & ~contact & ~landing
    return {SWINGING: air, TOUCH_DOWN: landing, STANCE: ~air & ~landing}


@dataclass(frozen=True)
class ShownPushes:
    """Pushes (T, n) [N m], V1..V3 [N], as they are, behind the observer's low-pass, and as an estimate shows them.

    An estimate shows what is left of it without all other external torque behind the low-pass: `behind` plus its error.
    """

    push: NDArray[Any]
    behind: NDArray[Any]
    estimate: NDArray[Any]


def shown_pushes(pair: Pair, scene: Scene) -> ShownPushes:
    """Return the pushes of a run's recording, and what its estimate shows of them."""
    gain_hz = read_array_note(file_of(pair.run.residual, NOTE))["gain_hz"]
    behind = scene.behind(gain_hz, pair.joints)
    error = pair.estimate.astype(np.float64) - pair.truth
    return ShownPushes(scene.pushes[:, scene.layout.columns(pair.joints)], behind, behind + error)
