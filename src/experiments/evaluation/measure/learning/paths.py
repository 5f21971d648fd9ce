"""By which inputs a hit enters a network's prediction: walks with and without the hit, with their inputs exchanged.

A walk and its twin, the same without hits, are equal up to the first hit, to the bit. A network runs on the twin with
some of its inputs taken from the walk with the hit; by how much its prediction changes is what these inputs bring in.
"""

from collections.abc import Sequence
from dataclasses import replace
from pathlib import Path

import numpy as np

from experiments.evaluation.compare.windows import push_windows
from experiments.evaluation.measure.learning.trials import ObservedWalks, estimator_of
from experiments.plan.runs import Tried
from mobnet.core.arrays import Array
from mobnet.core.errors import DataError
from mobnet.core.joints import N_VIRTUAL, NQ_BASE
from mobnet.core.recording import Sensed, SensedRecording
from mobnet.core.recording_file import read_sensed
from mobnet.estimation.estimate import ObservedRecording, run_segments
from mobnet.robot.description import describe

EVERY = "all inputs"
INPUTS = ("positions", "velocities", "desired torque", "inertial sensor")
GROUPS: dict[str, tuple[str, ...]] = {EVERY: INPUTS, **{name: (name,) for name in INPUTS}}


def taken_by_inputs(
    tried: Tried,
    hits: ObservedWalks,
    walks: Sequence[tuple[Path, Path]],
    after_s: float,
    joint: str,
) -> dict[str, float]:
    """Return the share of the first hit of each walk [-] that a network's prediction takes at a joint, by inputs.

    It is the slope of the change of the prediction on the hit behind the observer's low-pass, from the hit's beginning
    until some time [s] after its end, by least squares over all walks. `walks` are the recordings with hits and their
    twins, without endings; `hits` has the former.

    Raises:
        DataError: a walk and its twin differ before the first hit.
    """
    layout = describe(hits.robot).layout
    place = hits.joints.index(joint)
    spans: list[tuple[int, int]] = []
    for (stem, _), truth in zip(walks, hits.truths, strict=True):
        spans.append(push_windows(stem, len(truth), 0.0, after_s)[0])
    twins: list[Sensed] = []
    for (stem, other), read, (start, _) in zip(walks, hits.read, spans, strict=True):
        twin = read_sensed(other, layout).sensed
        if not np.array_equal(twin.q[:start], read.recording.sensed.q[:start]):
            raise DataError(f"{other}: differs from {stem} before the first hit; accepted: the same walk without hits")
        twins.append(twin)
    without = _predictions(tried, hits, twins, spans, joint)
    shares: dict[str, float] = {}
    for name, inputs in GROUPS.items():
        mixed = [mix(twin, read.recording.sensed, inputs) for twin, read in zip(twins, hits.read, strict=True)]
        predictions = _predictions(tried, hits, mixed, spans, joint)
        products = squares = 0.0
        for prediction, base, truth, (start, end) in zip(predictions, without, hits.truths, spans, strict=True):
            push = truth[start:end, place]
            products += float(push @ (prediction - base)[start:end])
            squares += float(push @ push)
        shares[name] = products / squares
    return shares


def mix(twin: Sensed, hit: Sensed, inputs: Sequence[str]) -> Sensed:
    """Return what was sensed in a walk without a hit, with some of `INPUTS` as they are in the same walk with it."""
    n = min(len(twin), len(hit))
    twin, hit = twin[:n], hit[:n]
    q, v = twin.q.copy(), twin.v.copy()
    if "positions" in inputs:
        q[:, NQ_BASE:] = hit.q[:, NQ_BASE:]
    if "velocities" in inputs:
        v[:, N_VIRTUAL:] = hit.v[:, N_VIRTUAL:]
    if "inertial sensor" in inputs:
        q[:, :NQ_BASE] = hit.q[:, :NQ_BASE]
        v[:, :N_VIRTUAL] = hit.v[:, :N_VIRTUAL]
    return replace(
        twin,
        q=q,
        v=v,
        tau_des=hit.tau_des if "desired torque" in inputs else twin.tau_des,
        acc_base_in_base=hit.acc_base_in_base if "inertial sensor" in inputs else twin.acc_base_in_base,
    )


def _predictions(
    tried: Tried,
    hits: ObservedWalks,
    sensed: Sequence[Sensed],
    spans: Sequence[tuple[int, int]],
    joint: str,
) -> list[Array]:
    """Return what a network predicts of a joint from what was sensed, up to the end of the first hit (T_i,) [N m]."""
    cut: list[ObservedRecording] = []
    for signals, read, (_, end) in zip(sensed, hits.read, spans, strict=True):
        assert read.residual is not None
        recording = SensedRecording(signals[:end], ((0, end),), read.recording.rate_hz, read.recording.meta)
        cut.append(ObservedRecording(recording, read.residual[:end]))
    estimator = estimator_of(tried, hits)
    column = estimator.joints.index(joint)
    whole = describe(hits.robot).layout.columns([joint])[0]
    estimates = run_segments(estimator, cut)
    predictions: list[Array] = []
    for estimate, read in zip(estimates, cut, strict=True):
        assert read.residual is not None
        predictions.append(read.residual[:, whole].astype(np.float64) - estimate.tau_ext[:, column])
    return predictions
