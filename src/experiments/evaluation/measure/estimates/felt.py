"""What an estimate shows of a single push at one joint, as demo, film and the page of pushes say it."""

from dataclasses import dataclass

import numpy as np

from experiments.evaluation.measure.estimates.peaks import HALF, MS, delays
from mobnet.core.arrays import Array


@dataclass(frozen=True)
class PushResponse:
    """What an estimate shows of one push at one joint.

    The table `peaks` has slopes over many pushes, which noise does not raise; of one push the peak is what can be seen.

    Attributes:
        peak_nm: largest torque in the direction of the push; what was shown just before the push is its zero [N m].
        share: the peak over that of the push behind the observer's low-pass [-].
        delay_ms: how much later it rises to half of the push's peak than the push itself [ms]; None if it never does.
    """

    peak_nm: float
    share: float
    delay_ms: float | None


def felt_of(push: Array, behind: Array, shown: Array, rate_hz: float) -> PushResponse:
    """Return what is shown of a push (T,) [N m], which behind the observer's low-pass is `behind` (T,) [N m].

    All begin one row before the push.
    """
    largest = int(np.abs(behind).argmax())
    peak = float((np.sign(behind[largest]) * (shown - shown[0])).max())
    true = float(abs(behind[largest]))
    if not true:
        return PushResponse(peak, 0.0, None)
    late = delays(push[:, None], shown[:, None], np.ones(1, dtype=bool))
    return PushResponse(peak, peak / true, float(late[0]) * MS / rate_hz if peak >= HALF * np.abs(push).max() else None)
