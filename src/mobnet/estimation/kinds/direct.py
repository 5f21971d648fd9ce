"""FTS-e2e of section 5.1: networks that are trained on the external torque and predict it without an observer."""

from collections.abc import Iterator, Sequence

from mobnet.core.errors import ConfigError, misfit
from mobnet.core.estimator import Estimate, Stretch
from mobnet.core.recording import Sensed
from mobnet.estimation.recipe import Recipe
from mobnet.formats.base import Section
from mobnet.formats.reading import Place
from mobnet.learning.deployed.limbs import LimbNetworks, State
from mobnet.settings.methods import Method


class DirectEstimator:
    """tau_e as limb networks predict it, without an observer; `joints` (n,) are the networks'."""

    def __init__(self, networks: LimbNetworks) -> None:
        self.joints = networks.joints
        self._networks = networks

    def init(self) -> State:
        """Return the state before the first sample, (hidden,) of each network."""
        return self._networks.init()

    def step(self, state: State, sample: Sensed) -> tuple[State, Estimate]:
        """Take one sample (1-D arrays); return the new state and tau_e, (n,) [N, N m]."""
        state, prediction = self._networks.step(state, sample)
        return state, Estimate(prediction.mean, prediction.std)

    def estimate(self, sensed: Sensed) -> Estimate:
        """Return tau_e of one contiguous recording, (T, n) [N, N m], from a fresh state."""
        (result,) = self.estimate_all([Stretch(sensed)])
        return result

    def estimate_all(self, stretches: Sequence[Stretch]) -> list[Estimate]:
        """Return tau_e of stretches side by side, (T_i, n) [N, N m], each from a fresh state."""
        predictions = self._networks.run_all([stretch.sensed for stretch in stretches])
        return [Estimate(prediction.mean, prediction.std) for prediction in predictions]


def check(method: Method, options: Section, rate_hz: float) -> Iterator[tuple[Place, str]]:
    """Yield what is not accepted in the row of a method: it has networks that learn the external torque."""
    if method.target != "external" or method.fitted or method.of:
        yield ("target",), misfit(method.target, "external, and neither `fitted` nor `of`")


def build(recipe: Recipe) -> DirectEstimator:
    """Build FTS-e2e of the method's limbs."""
    networks = recipe.limb_networks()
    if networks is None:
        raise ConfigError(f"method {recipe.name!r} of kind 'direct' names no limbs; accepted: one or more networks")
    return DirectEstimator(networks)
