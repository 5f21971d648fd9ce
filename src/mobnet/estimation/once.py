"""An observer or an estimator that several others run on the same samples, and that takes each of them once."""

from typing import Any, TypeVar, cast

from mobnet.core.recording import Sensed

Stepped = TypeVar("Stepped")


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
        before, seen, found = self._last
        if seen is not sample or before is not state:
            found = self._stepped.step(state, sample)
            self._last = state, sample, found
        return found
