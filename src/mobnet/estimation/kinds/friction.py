"""MOB-fric of section 5.2: the residual minus a friction model of the joints, regressed on r - tau_e of training data.

The model has the form of (23); (O10) and (O11) of docs/notes/observer.md say how it is regressed and subtracted.
"""

from collections.abc import Callable, Collection, Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Any, Literal, Protocol, TypeVar

import numpy as np
from numpy.typing import NDArray
from pydantic import ConfigDict, Field

from mobnet.core.arrays import Array
from mobnet.core.errors import DataError, misfit, not_accepted, refuse
from mobnet.core.joints import JointLayout
from mobnet.core.notes import Note, NotNegative, Text, read_note
from mobnet.core.notes import Positive as AboveZero
from mobnet.core.recording import Sensed
from mobnet.estimation.recipe import Recipe
from mobnet.estimation.regression import TERMS, Law, Pair, regress, regressors
from mobnet.estimation.residual import ResidualEstimator
from mobnet.formats.base import Distinct, Positive, Rising, Section
from mobnet.formats.network import Limb
from mobnet.formats.reading import Place
from mobnet.kernel.low_pass import exact_pole, low_pass
from mobnet.learning.deployed.networks import Prediction
from mobnet.settings.methods import Method, ObserverSettings
from mobnet.settings.networks import Network

Velocity = Annotated[Positive, Field(ge=0.0001, le=20)]
Term = Literal["coulomb", "static", "viscous", "load"]
Named = TypeVar("Named", bound=str)
LARGEST = 1e9  # of a fitted number


class Options(Section):
    """Terms of (23) to fit, the velocity that smooths the sign function, and those tried for the Stribeck term.

    Only joints whose network sees the torque get the term `load`.
    """

    terms: Distinct[Term]
    smoothing_rad_s: Velocity
    stribeck_rad_s: Rising[Velocity]


class FrictionJointNote(Note):
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
    joints: dict[str, FrictionJointNote]
    stamp: Text = "-"


class FrictionLaw(Protocol):
    """A model of the friction of all actuated joints (nu,), with what it remembers as its state."""

    def init(self) -> Any:
        """Return the state before the first sample."""
        ...

    def run(self, state: Any, velocity: NDArray[Any], torque: NDArray[Any], rate_hz: float) -> tuple[Any, NDArray[Any]]:
        """Return the state after samples of joint velocity [rad/s] and motor torque [N m], and tau_f [N m], (T, nu)."""
        ...


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

    def init(self) -> None:
        """Return the state before the first sample: (23) has none."""

    def run(self, state: None, velocity: NDArray[Any], torque: NDArray[Any], rate_hz: float) -> tuple[None, Array]:
        """Return tau_f of samples, (T, nu) [N m], and no state."""
        return None, self.torque(velocity, torque)


State = tuple[Any, Array | None]  # of the friction, and the filtered torque (nv,) [N, N m]


class FrictionModel:
    """The filtered friction torque as an uncertainty model of (15), for all joints (nv,); the base has none."""

    def __init__(self, layout: JointLayout, friction: FrictionLaw, gain_hz: float, rate_hz: float) -> None:
        """Take a fitted friction model, and the observer's gain K_0 of (7) [1/s]."""
        self.joints = layout.names
        self._base = len(layout.virtual)  # generalized velocities without a motor
        self._friction = friction
        self._gain_hz = gain_hz
        self._rate_hz = rate_hz
        self._pole = exact_pole(gain_hz, rate_hz)

    def init(self) -> State:
        """Return the state before the first sample: nothing is filtered yet."""
        return self._friction.init(), None

    def step(self, state: State, sample: Sensed) -> tuple[State, Prediction]:
        """Take one sample (1-D arrays); return the new state and the filtered friction (nv,) [N, N m]."""
        remembered, before = state
        remembered, (now,) = self._run(remembered, sample.v[None], sample.tau_motor[None])
        # (O11): the residual's share of friction has passed the observer's low-pass, so this must, with the same start.
        filtered = np.zeros_like(now) if before is None else self._pole * before + (1 - self._pole) * now
        return (remembered, filtered), Prediction(filtered)

    def run_all(self, recordings: Sequence[Sensed]) -> list[Prediction]:
        """Run over contiguous recordings, each from a fresh state; return the filtered friction (T_i, nv) [N, N m]."""
        torques = [self._run(self._friction.init(), sensed.v, sensed.tau_motor)[1] for sensed in recordings]
        return [Prediction(low_pass(torque, self._gain_hz, self._rate_hz)) for torque in torques]

    def _run(self, remembered: Any, v: NDArray[Any], torque: NDArray[Any]) -> tuple[Any, Array]:
        """Return the state of the friction after samples, and its torque before the filter, (T, nv) [N, N m]."""
        remembered, friction = self._friction.run(remembered, v[:, self._base :], torque, self._rate_hz)
        return remembered, np.concatenate([np.zeros((len(v), self._base)), friction], axis=-1)


def check(method: Method, options: Options, rate_hz: float) -> Iterator[tuple[Place, str]]:
    """Yield what is not accepted in the row of a method: a fit needs limbs, and no networks."""
    if not method.fitted or method.limbs or method.of:
        yield ("fitted",), misfit(list(method.fitted), "limbs to fit, without `limbs` and `of`")


def build(recipe: Recipe) -> ResidualEstimator:
    """Build MOB-fric: the residual minus the fitted friction."""
    return ResidualEstimator(recipe.observer(), recipe.layout, friction_model(recipe, read_friction))


def friction_model(recipe: Recipe, read: Callable[[Path, Sequence[str]], FrictionLaw]) -> FrictionModel:
    """Return the fitted friction of a method, whose file `read` reads for the robot's actuated joints.

    Raises:
        DataError: there is no fit, or its file is damaged.
    """
    if recipe.fitted is None:
        raise DataError(f"method {recipe.name!r} has no fitted friction; accepted: a method that names `fitted` limbs")
    friction = read(recipe.fitted, recipe.layout.actuated)
    return FrictionModel(recipe.layout, friction, recipe.observing.gain_hz, recipe.rate_hz)


def fit(
    layout: JointLayout,
    observer: ObserverSettings,
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
    factors: dict[str, Mapping[str, float]] = {}
    for limb, pairs in training.items():
        factors |= regress(law, fitted_joints(layout, options.terms, ("load",), [networks[limb]]), pairs)
    ordered = {joint: factors[joint] for joint in layout.actuated if joint in factors}
    return {"smoothing_rad_s": options.smoothing_rad_s, "joints": ordered}


def fitted_joints(
    layout: JointLayout, terms: Sequence[Named], of_torque: Collection[str], limbs: Iterable[Limb]
) -> dict[str, list[Named]]:
    """Return joint -> terms that are fitted, of the actuated joints of some networks.

    Terms `of_torque` are those of joints alone whose network sees the torque.
    """
    terms_of: dict[str, list[Named]] = {}
    for limb in limbs:
        learned = layout.limbs(limb.joints)
        seen = layout.limbs(limb.T)
        for joint in learned:
            if joint in layout.actuated:
                terms_of[joint] = [term for term in terms if term not in of_torque or joint in seen]
    return terms_of


def read_friction(path: Path, joints: Sequence[str]) -> FittedFriction:
    """Read what `fit` found, for a robot's actuated joints (nu,); joints that it does not name have no friction.

    Raises:
        DataError: the file is missing, damaged, or names a joint that the robot does not have.
    """
    note = read_note(path, FrictionNote)
    rows = note.joints
    refuse(path, [not_accepted("joint", name, joints) for name in rows if name not in joints])
    fitted = [rows[joint].terms() if joint in rows else dict.fromkeys(TERMS, 0.0) for joint in joints]
    terms = dict[str, Array]()
    for term in TERMS:
        terms[term] = np.array([factors[term] for factors in fitted], dtype=np.float64)
    stribeck = np.array([rows[joint].stribeck_rad_s if joint in rows else 1.0 for joint in joints], dtype=np.float64)
    return FittedFriction(terms, stribeck, note.smoothing_rad_s)
