"""Training data of one limb: inputs and target of Table 1 from recordings and their residuals, z-scored."""

import hashlib
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mobnet.core.columns import RESIDUAL, named
from mobnet.core.errors import DataError
from mobnet.core.joints import JointLayout
from mobnet.core.notes import read_array_note
from mobnet.core.store import NOTE, check_pair, check_rate, file_of, label_of, read_array, spans_and_rate
from mobnet.formats.network import Limb
from mobnet.kernel.detecting import Target
from mobnet.learning.features import LimbInputs, limb_inputs
from mobnet.learning.streams import Span
from mobnet.learning.swings import Margins, free_rows

Known = Callable[[Path, Sequence[str]], NDArray[Any]]  # recording, joints (n,) -> torque (T, n) [N, N m]
CONSTANT = 1e-9  # an input that moves less than this share of its mean counts as constant


@dataclass(frozen=True)
class ZScore:
    """Mean and standard deviation of each column, (n,), in the columns' units; z = (x - mean) / std."""

    mean: NDArray[np.float32]
    std: NDArray[np.float32]


@dataclass(frozen=True)
class LimbData:
    """All training samples of a limb, recordings laid end to end.

    Attributes:
        inputs: x^g of eq. (17), (N, n_in), in physical units.
        targets: torque to learn (N, n) [N, N m]; rows of nan where it is not known.
        segments: contiguous stretches (start, end) of rows.
        input_names: names of the inputs, (n_in,).
        joints: names of the limb's joints, (n,).
        rate_hz: samples per second [Hz].
        held_out: first row of the recordings that validate; without any, the end of every stretch does.
    """

    inputs: NDArray[np.float32]
    targets: NDArray[np.float32]
    segments: tuple[Span, ...]
    input_names: tuple[str, ...]
    joints: tuple[str, ...]
    rate_hz: float
    held_out: int | None = None

    @cached_property
    def digest(self) -> str:
        """Hash of every number of the data."""
        known = (self.segments, self.input_names, self.joints, self.rate_hz, self.held_out)
        digest = hashlib.sha256(repr(known).encode())
        for array in (self.inputs, self.targets):
            digest.update(np.ascontiguousarray(array).data)
        return digest.hexdigest()


def load_limb_data(
    layout: JointLayout,
    limb: Limb,
    target: Target,
    recordings: Sequence[Path],
    residuals: Sequence[Path],
    rate_hz: float | None = None,
    held_out: int = 0,
    known: Known | None = None,
    first_s: float | None = None,
    margins: Margins | None = None,
) -> LimbData:
    """Read recordings and residuals of one limb into RAM, inputs (N, n_in) and target torques (N, n) [N, N m].

    The target is the `uncertainty`, r - tau_e of section 4.2.3, or the `external` torque, tau_e, both low-passed alike.
    What is `known` of the target is subtracted from it. Residuals stand in the order of their recordings, of which the
    last `held_out` validate. Without a rate [Hz], any one is accepted. With `first_s`, only so many seconds are read.
    With margins, the target is r where a leg hangs in the air, whose external torque is zero, and nan elsewhere.

    Raises:
        DataError: a file is damaged, or a residual does not belong to its recording.
    """
    inputs = limb_inputs(layout, limb)
    joints = layout.limbs(limb.joints)
    for stem in recordings:
        check_rate(stem, rate_hz)
    # Each recording goes into its place at once: parts that are put together at the end would be there twice.
    starts = np.cumsum([0] + [read_array_note(file_of(stem, NOTE))["rows"] for stem in recordings]).tolist()
    xs = np.empty((starts[-1], len(inputs.names)), dtype=np.float32)
    ys = np.empty((starts[-1], len(joints)), dtype=np.float32)
    segments: list[Span] = []
    rates: set[float] = set()
    for recording, residual, (offset, end) in zip(recordings, residuals, pairwise(starts), strict=True):
        x, y, spans, rate = _load_one(layout, inputs, joints, target, recording, residual, margins)
        if known is not None:
            y -= known(recording, joints).astype(np.float32)
        xs[offset:end] = x
        ys[offset:end] = y
        segments += [(offset + first, offset + last) for first, last in spans]
        rates.add(rate)
    # A network counts time in samples, so a second rate would be another robot to it.
    if len(rates) != 1:
        raise DataError(f"recordings at {sorted(rates)} Hz cannot be mixed; accepted: one or more at a single rate")
    first = starts[-1 - held_out] if held_out else None
    rate = rates.pop()
    rows = len(xs) if first_s is None else min(len(xs), round(first_s * rate))
    spans = tuple((start, min(end, rows)) for start, end in segments if start < rows)
    return LimbData(xs[:rows], ys[:rows], spans, inputs.names, joints, rate, first)


def _load_one(
    layout: JointLayout,
    inputs: LimbInputs,
    joints: Sequence[str],
    target: Target,
    recording: Path,
    residual: Path,
    margins: Margins | None,
) -> tuple[NDArray[np.float32], NDArray[np.float32], tuple[Span, ...], float]:
    """Return inputs, targets, segments and rate of one recording."""
    check_pair(recording, residual)
    recorded, meta = read_array(recording, inputs.recorded, layout)
    if margins is None:
        torque = read_target(residual, joints, target)
    else:
        # (N2). Rows without a target stay, as the state has to run through them on its way to the next swing.
        torque = read_array(residual, named(RESIDUAL, joints))[0]
        torque[~free_rows(recording, layout, joints, margins)] = np.nan
    return inputs.from_recorded(recorded), torque, *spans_and_rate(meta)


def read_target(stem: Path, joints: Sequence[str], target: Target) -> NDArray[np.float32]:
    """Return the torque to learn of some joints, (T, n) [N, N m], from a residual file and its label."""
    # Both targets lag behind alike, as the file has tau_e behind the observer's low-pass, (O7) of
    # docs/notes/observer.md.
    external, _ = read_array(stem, named(label_of(stem), joints))
    if target == "external":
        return external
    residual, _ = read_array(stem, named(RESIDUAL, joints))
    return residual - external


def scale_of(array: NDArray[np.float32], spans: Sequence[Span]) -> ZScore:
    """Return mean and standard deviation of the columns of an array (N, n) over some spans of its rows.

    A constant column, such as a joint that a scenario holds still, gets the standard deviation 1.
    """
    # (N3), summed in float64: in float32 the sums of millions of samples would keep few digits.
    count = sum(end - start for start, end in spans)
    mean = np.sum([array[a:b].sum(axis=0, dtype=np.float64) for a, b in spans], axis=0) / count
    square = np.sum([np.square(array[a:b] - mean).sum(axis=0) for a, b in spans], axis=0) / count
    std = np.sqrt(square)
    # Divided by its standard deviation, the rounding errors of a constant would look like a signal.
    std[std <= CONSTANT * np.maximum(1.0, np.abs(mean))] = 1.0
    return ZScore(mean.astype(np.float32), std.astype(np.float32))
