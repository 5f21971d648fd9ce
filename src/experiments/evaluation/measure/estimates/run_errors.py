"""Errors of a whole run, and those around its pushes, together and one by one: measured on every test."""

from experiments.evaluation.compare.pair import Measured, Measures, Pair
from experiments.evaluation.compare.rmse import LABELLED, PUSH, PUSHED, RAW, relative_rmse, rmse, roughness
from experiments.evaluation.compare.scene import Scene
from experiments.evaluation.compare.windows import push_windows

ERROR = "rmse"


def measure(pair: Pair, scene: Scene) -> Measures:
    """Yield the errors of a whole run, then those around its pushes, (n,) each.

    Those against the raw truth and against the label of foot sensors have endings of their own.
    """
    yield Measured(ERROR, rmse(pair.estimate, pair.truth, pair.spans))
    yield Measured("roughness", roughness(pair.estimate, pair.spans, pair.rate_hz))
    yield Measured("r_rmse", relative_rmse(pair.estimate, pair.truth, pair.spans))
    raw = scene.external[:, scene.layout.columns(pair.joints)]
    yield Measured(ERROR + RAW, rmse(pair.estimate, raw, pair.spans))
    if pair.label is not None:
        yield Measured(ERROR + LABELLED, rmse(pair.estimate, pair.label, pair.spans))
    window = scene.asked.window
    windows = push_windows(scene.stem, len(raw), window.before_s, window.after_s) if window else ()
    pushes = {PUSHED: windows, **{PUSH.format(k): (around,) for k, around in enumerate(windows, start=1)}}
    for metric, spans in pushes.items() if windows else ():
        for ending, truth in (("", pair.truth), (RAW, raw)):
            yield Measured(metric + ending, rmse(pair.estimate, truth, spans))
