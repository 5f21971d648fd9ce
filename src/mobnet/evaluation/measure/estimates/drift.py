"""Whether an estimate holds a push that lasts: the share of it that it shows, over the time since it began."""

import numpy as np
from numpy.typing import NDArray

from mobnet.core.metrics import Metric
from mobnet.evaluation.compare.pair import Pair
from mobnet.evaluation.compare.rmse import Spans
from mobnet.evaluation.compare.scene import STANCE, SWINGING, Scene, shown_pushes
from mobnet.evaluation.compare.values import Measured, Measures
from mobnet.evaluation.compare.windows import flagged_spans, rows_in
from mobnet.settings.evaluation import Drift

HELD = "held_{}"  # phase: over the whole push
HELD_BIN = "held_{}_{}"  # phase and number of a bin of time, from 1 on
METRICS = (Metric("held_(swing|stance)(_[1-9][0-9]*)?", "-", low=None),)


def measure(pair: Pair, scene: Scene, settings: Drift) -> Measures:
    """Yield the share [-] of long pushes that an estimate of a leg shows, by phase and by time since the push began.

    With the push p behind the observer's low-pass and the error e of the estimate less its mean in this phase while
    nothing pushes, the share is 1 + sum(e p) / sum(p p) over the leg's joints and the samples: what least squares find
    of p in p + e. It is 1 for an estimate that holds the push and 0 for one that shows nothing of it. All that is not
    swing is stance. In the swing, p is all external torque; on the ground, the contact forces answer it.
    """
    shown, rate_hz = shown_pushes(pair, scene), pair.rate_hz
    error = shown.estimate - shown.behind
    since = rows_since(scene.pushed, pair.spans)
    calm = calm_rows(scene.pushed, pair.spans, round(settings.calm_s * rate_hz))
    bins, width = round(settings.longest_s / settings.bin_s), round(settings.bin_s * rate_hz)
    swing = scene.phases[SWINGING][:, scene.layout.columns(pair.joints)[0]]
    for name, phase in ((SWINGING, swing), (STANCE, ~swing)):
        rest = error - error[phase & calm].mean(axis=0) if np.any(phase & calm) else error
        inside = phase & (since >= 0) & (since < bins * width)
        parts = {HELD.format(name): inside}
        parts |= {HELD_BIN.format(name, k + 1): inside & (since // width == k) for k in range(bins)}
        for metric, rows in parts.items():
            share = share_shown(shown.behind[rows], rest[rows])
            yield Measured(metric, np.full(len(pair.joints), share), average_only=True)


def share_shown(push: NDArray[np.float64], error: NDArray[np.float64]) -> float:
    """Return the least-squares share [-] of a push (T, n) [N m] in it plus an error (T, n) [N m]; nan without one."""
    power = float(np.sum(push * push))
    return 1.0 + float(np.sum(push * error)) / power if power > 0.0 else float("nan")


def rows_since(pushed: NDArray[np.bool_], spans: Spans) -> NDArray[np.intp]:
    """Return how many rows ago the push that acts began (T,), -1 where none does."""
    since = np.full(len(pushed), -1, dtype=np.intp)
    for start, end in flagged_spans(pushed, spans, 0):
        since[start:end] = np.arange(end - start)
    return since


def calm_rows(pushed: NDArray[np.bool_], spans: Spans, after: int) -> NDArray[np.bool_]:
    """Return where nothing pushes and the last push ended more than some rows ago (T,)."""
    return rows_in(spans, len(pushed)) & ~rows_in(flagged_spans(pushed, spans, after), len(pushed))
