"""Whether an estimate holds a push that lasts: the share of it that it shows, step by step since it began."""

from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from experiments.evaluation.compare.pair import Measured, Measures, Pair
from experiments.evaluation.compare.rmse import Spans
from experiments.evaluation.compare.scene import STANCE, SWINGING, Scene, shown_pushes
from experiments.evaluation.compare.windows import flagged_spans, rows_in
from experiments.settings.measures import Drift

HELD = "held_{}"  # phase: over the whole push
HELD_STEP = "held_{}_{}"  # phase, and its number since the push began, from 1 on


def measure(pair: Pair, scene: Scene, settings: Drift) -> Measures:
    """Yield the share [-] of long pushes that an estimate of a leg shows, by phase and step by step.

    With the push p behind the observer's low-pass and the error e of the estimate less its mean in this phase while
    nothing pushes, the share is 1 + sum(e p) / sum(p p) over the leg's joints and the samples: what least squares find
    of p in p + e. It is 1 for an estimate that holds the push and 0 for one that shows nothing of it. All that is not
    swing is stance. In the swing, p is all external torque; on the ground, the contact forces answer it.

    The samples of a step are those of one swing, or of one stance, in every push: bins of time would hold other parts
    of a step each, and the error of the observer's model is another one in each part.
    """
    shown = shown_pushes(pair, scene)
    rate_hz = pair.rate_hz
    error = shown.estimate - shown.behind
    calm = calm_rows(scene.pushed, pair.spans, round(settings.calm_s * rate_hz))
    swing = scene.phases[SWINGING][:, scene.layout.columns(pair.joints)[0]]
    numbers = step_numbers(scene.pushed, scene.planned(pair.joints[0]), pair.spans)
    for (name, phase), number in zip(((SWINGING, swing), (STANCE, ~swing)), numbers, strict=True):
        rest = error - error[phase & calm].mean(axis=0) if np.any(phase & calm) else error
        parts = {HELD.format(name): phase & (number > 0)}
        parts |= {HELD_STEP.format(name, k + 1): phase & (number == k + 1) for k in range(settings.steps)}
        for metric, rows in parts.items():
            share = share_shown(shown.behind[rows], rest[rows])
            yield Measured(metric, np.full(len(pair.joints), share), average_only=True)


def share_shown(push: NDArray[np.float64], error: NDArray[np.float64]) -> float:
    """Return the least-squares share [-] of a push (T, n) [N m] in it plus an error (T, n) [N m]; nan without one."""
    power = float(np.sum(push * push))
    return 1.0 + float(np.sum(push * error)) / power if power > 0.0 else float("nan")


def step_numbers(
    pushed: NDArray[np.bool_], air: NDArray[np.bool_], spans: Spans
) -> tuple[NDArray[np.intp], NDArray[np.intp]]:
    """Return the number of the swing and of the stance (T,), (T,) that a row belongs to since the push that acts began.

    Both begin with 1, where nothing pushes they are 0. `air` is whether the plan has the foot in the air; the swings
    are parted from one another in the middle of the planned stances, and the stances in the middle of the swings, as a
    foot lifts off and touches down not quite when the plan says so.
    """
    middles: dict[bool, list[int]] = {False: [], True: []}
    for first, last in spans:
        edges = [first, *(first + 1 + np.flatnonzero(np.diff(air[first:last]))), last]
        for start, end in pairwise(edges):
            middles[bool(air[start])].append((start + end) // 2)
    numbers = np.zeros((2, len(pushed)), dtype=np.intp)
    for start, end in flagged_spans(pushed, spans, 0):
        for number, planned in zip(numbers, (False, True), strict=True):
            passed = np.searchsorted(middles[planned], np.arange(start, end), side="right")
            number[start:end] = 1 + passed - passed[0]
    return numbers[0], numbers[1]


def calm_rows(pushed: NDArray[np.bool_], spans: Spans, after: int) -> NDArray[np.bool_]:
    """Return where nothing pushes and the last push ended more than some rows ago (T,)."""
    return rows_in(spans, len(pushed)) & ~rows_in(flagged_spans(pushed, spans, after), len(pushed))
