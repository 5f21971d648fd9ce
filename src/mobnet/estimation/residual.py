"""External torque as the residual without what a model of the uncertainty predicts, eq. (15)."""

from collections.abc import Sequence
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray

from mobnet.core.estimator import Estimate, ResidualObserver, Stretch
from mobnet.core.joints import JointLayout
from mobnet.core.recording import Sensed
from mobnet.learning.deployed.networks import Prediction

State = tuple[Any, Any]  # of the observer and of the uncertainty model


class UncertaintyModel(Protocol):
    """Predicts the filtered uncertainty torque of some joints: limb networks, a friction regression."""

    @property
    def joints(self) -> tuple[str, ...]:
        """Names of its joints, (n,)."""
        ...

    def init(self) -> Any:
        """Return the state before the first sample."""
        ...

    def step(self, state: Any, sample: Sensed) -> tuple[Any, Prediction]:
        """Take one sample (1-D arrays); return the new state and the prediction (n,) [N, N m]."""
        ...

    def run_all(self, recordings: Sequence[Sensed]) -> list[Prediction]:
        """Run over contiguous recordings, each from a fresh state; return the predictions (T_i, n) [N, N m]."""
        ...


class ResidualEstimator:
    """tau_e = r - tau_u of eq. (15): MOB without an uncertainty model, MOB-Net with limb networks.

    Attributes:
        joints: names of the estimated joints, (n,): the uncertainty model's, or all of the robot's without one.
    """

    def __init__(
        self, observer: ResidualObserver, layout: JointLayout, uncertainty: UncertaintyModel | None = None
    ) -> None:
        """Join an observer and a model of what it cannot know; None for MOB."""
        self.joints = layout.names if uncertainty is None else uncertainty.joints
        self._observer = observer
        self._uncertainty = uncertainty
        self._columns = layout.columns(self.joints)

    def init(self) -> State:
        """Return the state before the first sample."""
        return self._observer.init(), self._uncertainty.init() if self._uncertainty else None

    def step(self, state: State, sample: Sensed) -> tuple[State, Estimate]:
        """Take one sample (1-D arrays); return the new state and tau_e, (n,) [N, N m]."""
        observed, residual = self._observer.step(state[0], sample)
        # MOB is the case without a model of the uncertainty: all of r counts as external torque.
        if self._uncertainty is None:
            return (observed, None), self._estimate(residual)
        modelled, prediction = self._uncertainty.step(state[1], sample)
        return (observed, modelled), self._estimate(residual, prediction)

    def estimate(self, sensed: Sensed) -> Estimate:
        """Return tau_e of one contiguous recording, (T, n) [N, N m], from a fresh state."""
        (result,) = self.estimate_all([Stretch(sensed)])
        return result

    def estimate_all(self, stretches: Sequence[Stretch]) -> list[Estimate]:
        """Return tau_e of stretches, (T_i, n) [N, N m], each from a fresh state; the networks run side by side."""
        residuals = [s.residual if s.residual is not None else self._observer.residual(s.sensed) for s in stretches]
        if self._uncertainty is None:
            return [self._estimate(residual) for residual in residuals]
        predictions = self._uncertainty.run_all([stretch.sensed for stretch in stretches])
        return [self._estimate(*pair) for pair in zip(residuals, predictions, strict=True)]

    def _estimate(self, residual: NDArray[np.float64], prediction: Prediction | None = None) -> Estimate:
        """Return tau_e of the estimated joints, (..., n) [N, N m]."""
        # (O9) of docs/notes/observer.md, from (15). The observer's lag stays in it: what is estimated is the low-passed
        # torque.
        tau = residual[..., self._columns]
        if prediction is None:
            return Estimate(tau)
        return Estimate(tau - prediction.mean, prediction.std, prediction.mean)
