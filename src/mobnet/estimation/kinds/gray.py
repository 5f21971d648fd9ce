"""A gray box: networks that learn what a friction model leaves of the uncertainty, tau_e = r - friction - networks."""

from collections.abc import Iterator, Sequence
from typing import Any

from mobnet.core.errors import ConfigError, misfit
from mobnet.core.joints import JointLayout
from mobnet.core.recording import Sensed
from mobnet.estimation.kinds.friction import FrictionModel, friction_model, read_friction
from mobnet.estimation.recipe import Recipe
from mobnet.estimation.residual import ResidualEstimator
from mobnet.formats.base import Section
from mobnet.formats.reading import Place
from mobnet.learning.deployed.limbs import LimbNetworks
from mobnet.learning.deployed.networks import Prediction
from mobnet.settings.methods import Method

State = tuple[Any, Any]  # of the friction model and of the networks


class FrictionAndNetworks:
    """The sum of a friction model and of networks as an uncertainty model of (15); `joints` (n,) are the networks'."""

    def __init__(self, layout: JointLayout, friction: FrictionModel, networks: LimbNetworks) -> None:
        self.joints = networks.joints
        self._friction = friction
        self._networks = networks
        self._columns = layout.columns(networks.joints)

    def init(self) -> State:
        """Return the state before the first sample."""
        return self._friction.init(), self._networks.init()

    def step(self, state: State, sample: Sensed) -> tuple[State, Prediction]:
        """Take one sample (1-D arrays); return the new state and the prediction (n,) [N, N m]."""
        rubbed, known = self._friction.step(state[0], sample)
        learned, rest = self._networks.step(state[1], sample)
        return (rubbed, learned), self._sum(known, rest)

    def run_all(self, recordings: Sequence[Sensed]) -> list[Prediction]:
        """Run over contiguous recordings, each from a fresh state; return the predictions (T_i, n) [N, N m]."""
        known = self._friction.run_all(recordings)
        rest = self._networks.run_all(recordings)
        return [self._sum(*pair) for pair in zip(known, rest, strict=True)]

    def _sum(self, known: Prediction, rest: Prediction) -> Prediction:
        """Return the sum (..., n) [N, N m] with the networks' standard deviation."""
        # The target of the networks was r - tau_e less this friction, (O14), so the two add up to the uncertainty. The
        # fit says nothing of its own error; the networks' sigma, trained on what it leaves, contains it.
        return Prediction(known.mean[..., self._columns] + rest.mean, rest.std)


def check(method: Method, options: Section, rate_hz: float) -> Iterator[tuple[Place, str]]:
    """Yield what is not accepted in the row of a method: it has networks, and `of`, whose fit they build upon."""
    if method.target != "uncertainty" or method.of is None:
        yield ("target",), misfit(method.target, "uncertainty, with `of`, the method whose friction is known")


def build(recipe: Recipe) -> ResidualEstimator:
    """Build the gray box of the method's limbs on the fit of the method that `of` names."""
    networks = recipe.limb_networks()
    if networks is None:
        raise ConfigError(f"method {recipe.name!r} of kind 'gray' names no limbs; accepted: one or more networks")
    model = FrictionAndNetworks(recipe.layout, friction_model(recipe, read_friction), networks)
    return ResidualEstimator(recipe.observer(), recipe.layout, model)
