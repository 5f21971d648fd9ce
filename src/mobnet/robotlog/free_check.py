"""The free-motion check: how well a network does on the end of a log, which it never saw, and whether the log suffices.

Errors are those of the external torque against its label. In free motion the truth is zero, so that estimating nothing
has no error there: then the question is by how much the network's error is below that of the observer.
"""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mobnet.core.arrays import Array
from mobnet.core.epochs import read_epochs
from mobnet.core.estimator import Estimate
from mobnet.learning.calibration import coverage
from mobnet.learning.dataset import LimbData
from mobnet.learning.deployed.networks import Runnable
from mobnet.learning.streams import Span
from mobnet.robotlog.planted_check import PlantedCheck
from mobnet.settings.robotlog import LogLearning

SHARES = (0.68, 0.95)  # of errors within the interval that sigma gives


@dataclass(frozen=True)
class Held:
    """A network on the part of some logs that is held out, all of it laid end to end.

    Attributes:
        rows: of the logs (T,).
        segments: contiguous stretches (start, end) of the part's own rows.
        estimate: errors of the external torque and their standard deviation (T, n) [N, N m].
        seen: errors on as long a part that trained it (S, n) [N, N m].
    """

    rows: NDArray[np.intp]
    segments: tuple[Span, ...]
    estimate: Estimate
    seen: NDArray[Any]


@dataclass(frozen=True)
class ValidationSummary:
    """What a training did on its validation: which of its epochs is kept, and the loss (22) of that and of the last."""

    kept: int
    epochs: int
    loss: float
    last: float


@dataclass(frozen=True)
class FreeCheck:
    """What the check shows of n joints, on the part that is held out.

    Attributes:
        joints: their names (n,).
        units: of their torques (n,).
        seconds: how long the part is [s].
        zero: root mean square of the label, which is the error of estimating nothing (n,) [N, N m].
        observer: that of the error of the observer (n,) [N, N m].
        network: that of the error of the network (n,) [N, N m].
        seen: the same on as long a part that trained it (n,) [N, N m].
        covered: share of the errors within the interval of each of `SHARES`, (2, n).
        outside: share of the samples with an input outside the range of training.
        widest: the input that is outside most often; empty where none is.
    """

    joints: tuple[str, ...]
    units: tuple[str, ...]
    seconds: float
    zero: Array
    observer: Array
    network: Array
    seen: Array
    covered: Array
    outside: float
    widest: str

    def note(self) -> dict[str, Any]:
        """Return it as JSON for `run.json`."""
        return {name: value.tolist() if isinstance(value, np.ndarray) else value for name, value in vars(self).items()}


def held_out(network: Runnable, data: LimbData, cut: int) -> Held:
    """Run a network on the samples from a row on, and on as many before it."""
    spans_held_out = [(max(start, cut), end) for start, end in data.segments if end > cut]
    length = sum(end - start for start, end in spans_held_out)
    first = next((start for start, end in data.segments if start < cut <= end), 0)
    # An error that is larger on what is held out than on data that trained the network says that more data would help.
    spans = [*spans_held_out, (max(first, cut - length), cut)]
    predictions = network.run_all([data.inputs[start:end] for start, end in spans])
    errors = [data.targets[a:b] - prediction.mean for (a, b), prediction in zip(spans, predictions, strict=True)]
    stds = [prediction.std for prediction in predictions[:-1] if prediction.std is not None]
    ends = np.cumsum([end - start for start, end in spans_held_out]).tolist()
    segments = tuple(zip([0, *ends[:-1]], ends, strict=True))
    rows = np.concatenate([np.arange(a, b) for a, b in spans_held_out])
    return Held(rows, segments, Estimate(np.concatenate(errors[:-1]), np.concatenate(stds)), errors[-1])


def free_check(rest: Held, data: LimbData, label: Array, cut: int, units: Sequence[str], margin: float) -> FreeCheck:
    """Measure what a network did on the part of logs that is held out.

    Args:
        rest: the network on that part.
        data: of the whole logs; targets are the residual less the label.
        label: external torque of the joints that is known (N, n) [N, N m].
        cut: first row that is held out.
        units: of the joints' torques (n,).
        margin: share of an input's range by which it may lie outside.
    """
    rows = rest.rows
    errors = rest.estimate.tau_ext
    std = rest.estimate.std
    assert std is not None
    low = data.inputs[:cut].min(axis=0)
    high = data.inputs[:cut].max(axis=0)
    beyond = np.maximum(low - data.inputs[rows], data.inputs[rows] - high) > margin * (high - low)
    often = beyond.mean(axis=0)
    return FreeCheck(
        joints=data.joints,
        units=tuple(units),
        seconds=len(rows) / data.rate_hz,
        zero=_size(label[rows]),
        observer=_size(data.targets[rows]),
        network=_size(errors),
        seen=_size(rest.seen),
        covered=coverage(errors, std, SHARES),
        outside=float(beyond.any(axis=1).mean()),
        widest=data.input_names[int(np.argmax(often))] if often.any() else "",
    )


def course_of(metrics: Path, kept: int) -> ValidationSummary:
    """Read the course of a training from `metrics.csv`, of whose epochs one is kept."""
    epochs, _ = read_epochs(metrics)
    return ValidationSummary(kept, len(epochs), epochs[kept - 1].validation_loss, epochs[-1].validation_loss)


def lines_of(
    check: FreeCheck, labels: str, numbers: LogLearning, course: ValidationSummary, planted: PlantedCheck | None = None
) -> Iterator[str]:
    """Yield what the command prints of a check by some labels, of a training, and of pushes planted into that part."""
    what = "free-motion check" if labels == "free" else f"check by the labels {labels!r}"
    yield f"{what}, the last {check.seconds:.0f} s, which the network never saw: root mean square errors"
    width = max(map(len, ("joint", *check.joints)))
    yield f"  {'joint':<{width}} {'nothing':>9}{'observer':>10}{'network':>9}      sigma holds 68 %   95 %"
    for k, joint in enumerate(check.joints):
        sizes = f"{check.zero[k]:9.3f}{check.observer[k]:10.3f}{check.network[k]:9.3f} {check.units[k]:<4}"
        yield f"  {joint:<{width}} {sizes}{check.covered[0, k]:16.0%}{check.covered[1, k]:9.0%}"
    if planted:
        yield planted.line()
    faults = [*_faults(check, numbers), *_faults_of_course(check, course, numbers)]
    if planted and not planted.has_network:
        faults.append("a detector with the network does not find more than one without it: record for longer")
    yield f"the log suffices: {'yes' if not faults else 'no'}"
    yield from (f"  {fault}" for fault in faults)


def _faults(check: FreeCheck, numbers: LogLearning) -> Iterator[str]:
    """Yield why a log does not suffice."""
    if check.outside > numbers.outside:
        yield (
            f"{check.outside:.1%} of the held-out samples have an input outside the range of training, most often "
            f"{check.widest}: record more varied motion"
        )
    ratio = np.sqrt(np.mean(np.square(check.network / np.maximum(check.seen, 1e-12))))
    if ratio > numbers.worse:
        yield f"the error is {ratio:.1f} times that on data that trained the network: record for longer"
    if worse := [joint for k, joint in enumerate(check.joints) if check.network[k] >= check.observer[k]]:
        yield f"the network's error is not below the observer's at {', '.join(worse)}: keep the observer alone there"


def _faults_of_course(check: FreeCheck, course: ValidationSummary, numbers: LogLearning) -> Iterator[str]:
    """Yield what a training and its standard deviation say against a log."""
    if course.last > course.loss + numbers.rises:
        yield (
            f"the validation rises after epoch {course.kept} of {course.epochs}, which is kept, from {course.loss:.2f} "
            f"to {course.last:.2f}: the network learns this log by heart, record for longer"
        )
    covered = check.covered[0]
    if wrong := [
        joint for joint, share in zip(check.joints, covered, strict=True) if abs(share - SHARES[0]) > numbers.sigma
    ]:
        yield (
            f"sigma holds {covered.min():.0%} to {covered.max():.0%} of the errors in place of {SHARES[0]:.0%}, "
            f"wrong at {', '.join(wrong)}: record more varied motion"
        )


def _size(values: NDArray[Any]) -> Array:
    """Return the root mean square of each column of values (T, n)."""
    return np.sqrt(np.square(values).mean(axis=0, dtype=np.float64))
