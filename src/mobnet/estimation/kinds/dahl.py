"""MOB-fric-dahl: the residual minus friction with a memory, eight numbers and one state for each joint.

The state is Dahl's: friction follows a reversal over an angle, as gears of robots have it and (23) does not. (O19) and
(O20) of docs/notes/observer.md have the law, docs/notes/friction.md what it leaves.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Annotated, Any, Literal

import numpy as np
from numpy.typing import NDArray
from pydantic import ConfigDict, Field

from mobnet.core.arrays import Array
from mobnet.core.errors import not_accepted, refuse
from mobnet.core.joints import JointLayout
from mobnet.core.notes import Note, NotNegative, Text, read_note
from mobnet.core.notes import Positive as AboveZero
from mobnet.estimation.kinds.friction import LARGEST, check, fitted_joints, friction_model
from mobnet.estimation.recipe import Recipe
from mobnet.estimation.regression import Pair, logged, non_negative, square_sums
from mobnet.estimation.residual import ResidualEstimator
from mobnet.formats.base import Positive, Rising, Section
from mobnet.kernel.drive import bent
from mobnet.settings.methods import ObserverSettings
from mobnet.settings.networks import Network

__all__ = ["Options", "build", "check", "fit"]  # what a kind has

BENT = ("forward_nm", "backward_nm", "driving", "driven")  # terms that follow the bend
TERMS = (*BENT, "viscous_nms", "constant_nm", "gain")  # columns, then the target
FREE = ("constant_nm", "gain")  # of either sign: errors of the sensors, which dissipate nothing
OF_TORQUE = ("driving", "driven", "gain")
STILL = 1e-3  # root mean square of a column below which the recordings did not move it: its factor is zero


class Options(Section):
    """Angles over which a joint breaks away, of which each joint takes the best [rad]."""

    breakaway_rad: Rising[Annotated[Positive, Field(ge=1e-5, le=1)]]


class DahlJointNote(Note):
    """The fitted numbers of a joint, and the root mean square of the target and of what is left of it [N m].

    `driving` and `driven` are friction for each torque of the motor, `gain` is the share of it that the joint lacks.
    Bounds are wide: what the training data hardly move can be large.
    """

    model_config = ConfigDict(extra="forbid")

    breakaway_rad: Annotated[AboveZero, Field(le=1)]
    forward_nm: Annotated[NotNegative, Field(le=LARGEST)]
    backward_nm: Annotated[NotNegative, Field(le=LARGEST)]
    driving: Annotated[NotNegative, Field(le=LARGEST)]
    driven: Annotated[NotNegative, Field(le=LARGEST)]
    viscous_nms: Annotated[NotNegative, Field(le=LARGEST)]
    constant_nm: Annotated[float, Field(ge=-1000, le=1000)]
    gain: Annotated[float, Field(ge=-100, le=100)]
    target_rms_nm: NotNegative = 0.0
    left_rms_nm: NotNegative = 0.0


class DahlNote(Note):
    """The file of a fit."""

    model_config = ConfigDict(extra="forbid")

    law: Literal["dahl"]
    joints: dict[str, DahlJointNote]
    stamp: Text = "-"


@dataclass(frozen=True)
class DahlFriction:
    """Numbers of (O20) of every actuated joint; zero for a joint that was not fitted.

    Attributes:
        factors: term of `TERMS` -> its factor (nu,), units in the keys.
        breakaway: angle over which friction follows a reversal (nu,) [rad].
    """

    factors: Mapping[str, Array]
    breakaway: Array

    def init(self) -> Array:
        """Return the bends before the first sample, (nu,): none."""
        return np.zeros(len(self.breakaway))

    def run(
        self, state: Array, velocity: NDArray[Any], torque: NDArray[Any], rate_hz: float
    ) -> tuple[Array, NDArray[Any]]:
        """Return the bends after samples of joint velocity [rad/s] and motor torque [N m], and tau_f [N m], (T, nu)."""
        bend = state.copy()
        columns = regressors(velocity, torque, bent(bend, velocity, self.breakaway, rate_hz))
        return bend, -sum((self.factors[term] * columns[term] for term in TERMS), start=np.zeros(velocity.shape))


def regressors(velocity: NDArray[Any], torque: NDArray[Any], bend: Array) -> dict[str, NDArray[Any]]:
    """Return term -> what its factor multiplies in -tau_f of (O20), of velocity [rad/s], torque [N m] and bend."""
    loaded = np.abs(torque) * bend
    drives = torque * bend > 0
    return {
        "forward_nm": np.maximum(bend, 0.0),
        "backward_nm": np.minimum(bend, 0.0),
        "driving": loaded * drives,
        "driven": loaded * ~drives,
        "viscous_nms": velocity,
        "constant_nm": np.ones_like(velocity),
        "gain": torque,
    }


def build(recipe: Recipe) -> ResidualEstimator:
    """Build MOB-fric-dahl: the residual minus the fitted friction."""
    return ResidualEstimator(recipe.observer(), recipe.layout, friction_model(recipe, read_dahl))


def fit(
    layout: JointLayout,
    observer: ObserverSettings,
    options: Options,
    networks: Mapping[str, Network],
    training: Mapping[str, Sequence[Pair]],
) -> dict[str, Any]:
    """Regress the friction of the joints of each limb's network, which has terms of the torque where that sees it.

    Return `law`, and `joints`: name -> numbers of (O20), units in the keys, and the root mean square of the target and
    of what is left of it [N m].
    """
    angles = np.array(options.breakaway_rad)
    numbers = dict[str, Mapping[str, float]]()
    for limb, pairs in training.items():
        terms = fitted_joints(layout, TERMS, OF_TORQUE, [networks[limb]])
        sums = square_sums(partial(_columns, angles), list(terms), observer.gain_hz, pairs)
        numbers |= {joint: logged(joint, _solve(sums[joint], terms[joint], angles)) for joint in terms}
    return {"law": "dahl", "joints": {joint: numbers[joint] for joint in layout.actuated if joint in numbers}}


def _columns(angles: Array, velocity: Array, torque: Array, rate_hz: float) -> Array:
    """Return the regressors of one joint, (T, m - 1): those of `BENT` with each of the angles (k,), then the others."""
    bends = bent(np.zeros(len(angles)), np.tile(velocity[:, None], len(angles)), angles, rate_hz)
    return np.column_stack([*regressors(velocity[:, None], torque[:, None], bends).values()])


def _solve(products: Array, terms: Sequence[str], angles: Array) -> dict[str, float]:
    """Return the numbers of (O20) of one joint, with the best angle (k,) [rad], and the root mean squares [N m]."""
    solutions = [_at_angle(products, terms, i, len(angles)) for i in range(len(angles))]
    best = min(range(len(angles)), key=lambda i: solutions[i][1])
    factors, left = solutions[best]
    return {
        "breakaway_rad": float(angles[best]),
        **{term: factors.get(term, 0.0) for term in TERMS},
        "target_rms_nm": float(np.sqrt(products[-1, -1])),
        "left_rms_nm": left,
    }


def _at_angle(products: Array, terms: Sequence[str], i: int, count: int) -> tuple[dict[str, float], float]:
    """Return the factors with the i-th of so many angles, none negative but those of `FREE`, and what is left [N m]."""
    unit = np.eye(len(products))
    bending = unit[i : len(BENT) * count : count]
    others = unit[len(BENT) * count :]
    columns: dict[str, Array] = dict(zip(TERMS, (*bending, *others), strict=False))  # without the target's
    moved = {term: columns[term] for term in terms if columns[term] @ products @ columns[term] > STILL**2}
    return non_negative(products, moved, FREE)


def read_dahl(path: Path, joints: Sequence[str]) -> DahlFriction:
    """Read what `fit` found, for a robot's actuated joints (nu,); joints that it does not name have no friction.

    Raises:
        DataError: the file is missing, damaged, or names a joint that the robot does not have.
    """
    rows = read_note(path, DahlNote).joints
    refuse(path, [not_accepted("joint", name, joints) for name in rows if name not in joints])
    factors = dict[str, Array]()
    for term in TERMS:
        factors[term] = np.array([getattr(rows.get(joint), term, 0.0) for joint in joints])
    return DahlFriction(factors, np.array([getattr(rows.get(joint), "breakaway_rad", 1.0) for joint in joints]))
