"""The interface of estimators of the external torque, for whole recordings and for a closed loop."""

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Any, Protocol, TypeVar, cast, runtime_checkable

import numpy as np
from numpy.typing import NDArray

from mobnet.core.recording import Sensed

Stepped = TypeVar("Stepped")  # an observer or an estimator


@dataclass(frozen=True)
class Estimate:
    """Estimated external torque of an estimator's joints, of one sample (n,) or of a recording (T, n).

    Attributes:
        tau_ext: mean of the external torque (..., n) [N, N m], tau_e of (15).
        std: its standard deviation (..., n) [N, N m], sigma_u of (18); None where the method gives none.
        uncertainty: what the method takes off the residual (..., n) [N, N m], tau_u of (15); None where it is nothing.
    """

    tau_ext: NDArray[Any]
    std: NDArray[Any] | None = None
    uncertainty: NDArray[Any] | None = None


@dataclass(frozen=True)
class Stretch:
    """A contiguous stretch of a recording for an estimator to run over.

    Attributes:
        sensed: what the robot sensed, T samples.
        residual: r of (9) where an observer has run over it already (T, nv) [N, N m].
    """

    sensed: Sensed
    residual: NDArray[Any] | None = None


class TorqueEstimator(Protocol):
    """A way to estimate the external torque from proprioception alone; its state is explicit.

    `step` from `init` on, sample by sample, gives what `estimate` gives for the whole recording.
    """

    @property
    def joints(self) -> tuple[str, ...]:
        """Names of the estimated joints, (n,)."""
        ...

    def init(self) -> Any:
        """Return the state before the first sample."""
        ...

    def step(self, state: Any, sample: Sensed) -> tuple[Any, Estimate]:
        """Return the state after a sample (1-D arrays) and its estimate, arrays (n,) [N, N m]."""
        ...

    def estimate(self, sensed: Sensed) -> Estimate:
        """Return the estimate of one contiguous recording, arrays (T, n) [N, N m], from a fresh state."""
        ...


@runtime_checkable
class Together(TorqueEstimator, Protocol):
    """An estimator that runs over several stretches side by side in less time than one after the other."""

    def estimate_all(self, stretches: Sequence[Stretch]) -> list[Estimate]:
        """Return the estimates of stretches, arrays (T_i, n) [N, N m], each from a fresh state."""
        ...


def estimate_all(estimator: TorqueEstimator, stretches: Sequence[Stretch]) -> list[Estimate]:
    """Return the estimates of stretches, arrays (T_i, n) [N, N m], side by side if the estimator can do that."""
    if isinstance(estimator, Together):
        return estimator.estimate_all(stretches)
    return [estimator.estimate(stretch.sensed) for stretch in stretches]


def once(stepped: Stepped) -> Stepped:
    """Return something with `init` and `step` whose last step is not made again for the same state and sample.

    All that run it begin with the same state, and go on with the same one as long as they take the same samples, which
    are told apart by which object they are. A step does not change the state that it gets, so that it makes no
    difference who asks first.
    """
    return cast(Any, _Once(stepped))


class _Once:
    """What `once` returns."""

    def __init__(self, stepped: Any) -> None:
        self._stepped = stepped
        self._fresh = stepped.init()
        self._last: tuple[Any, ...] = (None, None, None)

    def __getattr__(self, name: str) -> Any:
        """Return what is no step."""
        return getattr(self._stepped, name)

    def init(self) -> Any:
        """Return the state before the first sample."""
        return self._fresh

    def step(self, state: Any, sample: Sensed) -> Any:
        """Take one sample; return the new state, and the residual or the estimate."""
        before, seen, stepped = self._last
        if seen is not sample or before is not state:
            stepped = self._stepped.step(state, sample)
            self._last = state, sample, stepped
        return stepped


class ResidualObserver(Protocol):
    """An observer of the residual r of (9) of all joints, (nv,); its state is explicit."""

    def init(self) -> Any:
        """Return the state before the first sample."""
        ...

    def step(self, state: Any, sample: Sensed) -> tuple[Any, NDArray[np.float64]]:
        """Take one sample (1-D arrays); return the new state and r, (nv,) [N] and [N m]."""
        ...

    def residual(self, sensed: Sensed) -> NDArray[np.float64]:
        """Return r over one contiguous recording, (T, nv) [N] and [N m], from a fresh state."""
        ...
