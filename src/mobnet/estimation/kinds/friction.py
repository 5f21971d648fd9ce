"""MOB-fric of section 5.2: the residual minus a friction model of the joints, regressed on r - tau_e of training data.

The model has the form of (23); (O10) and (O11) of docs/notes/0034-observer.md say how it is regressed and subtracted.
"""

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any, Literal

import numpy as np
from numpy.typing import NDArray
from pydantic import ConfigDict, Field

from mobnet.core.arrays import Array
from mobnet.core.errors import DataError, misfit, not_accepted, refuse
from mobnet.core.joints import JointLayout
from mobnet.core.notes import Note, NotNegative, Text, read_note
from mobnet.core.notes import Positive as AboveZero
from mobnet.core.recording import Sensed
from mobnet.estimation.kinds.residual import ResidualEstimator
from mobnet.estimation.low_pass import exact_pole, low_pass
from mobnet.estimation.recipe import Recipe
from mobnet.estimation.regression import TERMS, Law, Pair, regress, regressors
from mobnet.learning.deployed.networks import Prediction
from mobnet.settings.base import Distinct, Positive, Rising, Section
from mobnet.settings.methods import Method, Observer
from mobnet.settings.networks import Limb, Network
from mobnet.settings.reading import Place

Velocity = Annotated[Positive, Field(ge=0.0001, le=20)]
Term = Literal["coulomb", "static", "viscous", "load"]
LARGEST = 1e9  # of a fitted number


class Options(Section):
    """Terms of (23) to fit, of which only joints whose network sees the torque get `load`; sign function; grid."""

    terms: Distinct[Term]
    smoothing_rad_s: Velocity
    stribeck_rad_s: Rising[Velocity]


class JointNote(Note):
    """The fitted numbers of a joint, and the root mean square of the target and of what is left of it [N m].

    Bounds are wide: what the training data hardly move can be large, where the Stribeck term has all but faded.
    """

    model_config = ConfigDict(extra="forbid")

    coulomb_nm: Annotated[NotNegative, Field(le=1000)]
    static_nm: Annotated[NotNegative, Field(le=LARGEST)]
    viscous_nms: Annotated[NotNegative, Field(le=LARGEST)]
    load_per_nm: Annotated[NotNegative, Field(le=1)]
    stribeck_rad_s: Annotated[AboveZero, Field(le=20)]
    target_rms_nm: NotNegative = 0.0
    left_rms_nm: NotNegative = 0.0

    def terms(self) -> dict[str, float]:
        """Return term -> its factor."""
        return {term: getattr(self, key) for term, key in TERMS.items()}


class FrictionNote(Note):
    """The file of a fit."""

    model_config = ConfigDict(extra="forbid")

    smoothing_rad_s: AboveZero
    joints: dict[str, JointNote]
    stamp: Text = "-"


@dataclass(frozen=True)
class FittedFriction:
    """Numbers of (23) of every actuated joint; zero for a joint that was not fitted.

    Attributes:
        terms: term of `TERMS` -> its factor (nu,): `coulomb`, `static` [N m], `viscous` [N m s], `load` [1/(N m)].
        stribeck: velocity over which static turns into Coulomb friction (nu,) [rad/s].
        smoothing: width of the sign function [rad/s].
    """

    terms: Mapping[str, Array]
    stribeck: Array
    smoothing: float

    def torque(self, velocity: NDArray[Any], torque: NDArray[Any]) -> Array:
        """Return tau_f of (23), (..., nu) [N m], from joint velocity [rad/s] and motor torque [N m], (..., nu) each."""
        # The factors of (O10) are those of -tau_f, where none of them may be negative.
        columns = regressors(velocity, torque, self.smoothing, self.stribeck)
        return -sum((self.terms[term] * columns[term] for term in TERMS), start=np.zeros(self.stribeck.shape))


class FrictionModel:
    """The filtered friction torque as an uncertainty model of (15), for all joints (nv,); the base has none."""

    def __init__(self, layout: JointLayout, friction: FittedFriction, gain_hz: float, rate_hz: float) -> None:
        """Take a fitted friction model, and the observer's gain K_0 of (7) [1/s]."""
        self.joints = layout.names
        self._base = len(layout.virtual)  # generalized velocities without a motor
        self._friction = friction
        self._gain_hz, self._rate_hz, self._pole = gain_hz, rate_hz, exact_pole(gain_hz, rate_hz)

    def init(self) -> Array | None:
        """Return the state before the first sample: none."""
        return None

    def step(self, state: Array | None, sample: Sensed) -> tuple[Array, Prediction]:
        """Take one sample (1-D arrays); return the filtered friction as new state and as prediction (nv,) [N, N m]."""
        now = self._torque(sample)
        # (O11): the residual's share of friction has passed the observer's low-pass, so this must, with the same start.
        filtered = np.zeros_like(now) if state is None else self._pole * state + (1 - self._pole) * now
        return filtered, Prediction(filtered)

    def run_all(self, recordings: Sequence[Sensed]) -> list[Prediction]:
        """Run over contiguous recordings, each from a fresh state; return the filtered friction (T_i, nv) [N, N m]."""
        torques = [self._torque(sensed) for sensed in recordings]
        return [Prediction(low_pass(torque, self._gain_hz, self._rate_hz)) for torque in torques]

    def _torque(self, sensed: Sensed) -> Array:
        """Return the friction torque before the filter, (..., nv) [N, N m]."""
        friction = self._friction.torque(sensed.v[..., self._base :], sensed.tau_motor)
        return np.concatenate([np.zeros((*friction.shape[:-1], self._base)), friction], axis=-1)


def check(method: Method, options: Options, rate_hz: float) -> Iterator[tuple[Place, str]]:
    """Yield what is not accepted in the row of a method: a fit needs limbs, and no networks."""
    if not method.fitted or method.limbs or method.of:
        yield ("fitted",), misfit(list(method.fitted), "limbs to fit, without `limbs` and `of`")


def build(recipe: Recipe) -> ResidualEstimator:
    """Build MOB-fric: the residual minus the fitted friction."""
    return ResidualEstimator(recipe.observer(), recipe.layout, friction_model(recipe))


def friction_model(recipe: Recipe) -> FrictionModel:
    """Return the fitted friction of a method.

    Raises:
        DataError: there is no fit, or its file is damaged.
    """
    if recipe.fitted is None:
        raise DataError(f"method {recipe.name!r} has no fitted friction; accepted: a method that names `fitted` limbs")
    friction = read_friction(recipe.fitted, recipe.layout.actuated)
    return FrictionModel(recipe.layout, friction, recipe.observing.gain_hz, recipe.rate_hz)


def fit(
    layout: JointLayout,
    observer: Observer,
    options: Options,
    networks: Mapping[str, Network],
    training: Mapping[str, Sequence[Pair]],
) -> dict[str, Any]:
    """Regress the friction of the joints of each limb's network; the network's `T` says which joints may have load.

    Return `smoothing_rad_s`, and `joints`: name -> factors of (23), units in the keys, and the root mean square of the
    target and of what is left of it [N m].
    """
    # By section 4.2.2 the load counts for the legs alone: there the limb's network sees the torque, its `T` in Table 1.
    law = Law(options.smoothing_rad_s, options.stribeck_rad_s, observer.gain_hz)
    found: dict[str, Mapping[str, float]] = {}
    for limb, pairs in training.items():
        found |= regress(law, fitted_joints(layout, options, [networks[limb]]), pairs)
    ordered = {joint: found[joint] for joint in layout.actuated if joint in found}
    return {"smoothing_rad_s": options.smoothing_rad_s, "joints": ordered}


def fitted_joints(layout: JointLayout, options: Options, limbs: Iterable[Limb]) -> dict[str, list[Term]]:
    """Return joint -> terms of (23) that are fitted, of the actuated joints of some networks; see `Options`."""
    found: dict[str, list[Term]] = {}
    for limb in limbs:
        learned, seen = layout.limbs(limb.joints), layout.limbs(limb.T)
        for joint in learned:
            if joint in layout.actuated:
                found[joint] = [term for term in options.terms if term != "load" or joint in seen]
    return found


def read_friction(path: Path, joints: Sequence[str]) -> FittedFriction:
    """Read what `fit` found, for a robot's actuated joints (nu,); joints that it does not name have no friction.

    Raises:
        DataError: the file is missing, damaged, or names a joint that the robot does not have.
    """
    found = read_note(path, FrictionNote)
    rows = found.joints
    refuse(path, [not_accepted("joint", name, joints) for name in rows if name not in joints])
    fitted = [rows[joint].terms() if joint in rows else dict.fromkeys(TERMS, 0.0) for joint in joints]
    terms = {term: np.array([factors[term] for factors in fitted], dtype=np.float64) for term in TERMS}
    stribeck = np.array([rows[joint].stribeck_rad_s if joint in rows else 1.0 for joint in joints], dtype=np.float64)
    return FittedFriction(terms, stribeck, found.smoothing_rad_s)
