"""Truth, estimates and flags of some joints of a recording, a gait cycle of it, and the panels cut out of them."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from experiments.evaluation.compare.pair import read_pair, read_std
from experiments.evaluation.compare.rmse import Spans
from experiments.evaluation.compare.windows import FLAG
from experiments.plan.runs import Run
from mobnet.core.columns import RESIDUAL, SWING, foot_of, named
from mobnet.core.errors import DataError
from mobnet.core.joints import JointLayout
from mobnet.core.store import read_array
from mobnet.kernel.low_pass import low_pass

TRUTH, TARGET = "truth", "target"  # labels: tau_e, and what is learned of the uncertainty, r - tau_e (section 4.2.3)
ZERO = "zero"  # the method that estimates no torque at all: its error is the torque


@dataclass(frozen=True)
class TorqueCurve:
    """A line over time (T,) [N m], V1..V3 [N], perhaps with a band of its standard deviation (T,) around it."""

    label: str
    values: NDArray[Any]
    std: NDArray[Any] | None = None


@dataclass(frozen=True)
class Panel:
    """Curves of one joint over some time (T,) [s], the last on top, and flags that hold or not (T,)."""

    title: str
    time: NDArray[Any]
    curves: Sequence[TorqueCurve]
    flags: Mapping[str, NDArray[Any]]


@dataclass(frozen=True)
class Curves:
    """Estimates of several methods for some joints (n,) of one recording, whose spans (start, end) are contiguous rows.

    Truth is the low-passed external torque, residual that of the momentum observer, both (T, n) [N m], V1..V3 [N], as
    are each method's estimate and standard deviation, None where it predicts none. Flags hold or not (T,).
    """

    joints: tuple[str, ...]
    truth: NDArray[Any]
    residual: NDArray[Any]
    estimates: Mapping[str, NDArray[Any]]
    stds: Mapping[str, NDArray[Any] | None]
    flags: Mapping[str, NDArray[np.bool_]]
    spans: Spans
    rate_hz: float

    def low_passed(self, cut_off_hz: float) -> "Curves":
        """Return all curves behind the first-order low-pass of the detector, which starts at their first values."""
        return replace(
            self,
            truth=self._low_passed(self.truth, cut_off_hz),
            residual=self._low_passed(self.residual, cut_off_hz),
            estimates={name: self._low_passed(values, cut_off_hz) for name, values in self.estimates.items()},
            stds={
                name: None if values is None else self._low_passed(values, cut_off_hz)
                for name, values in self.stds.items()
            },
        )

    def _low_passed(self, values: NDArray[Any], cut_off_hz: float) -> NDArray[Any]:
        """Return curves (T, n) behind a first-order low-pass."""
        return low_pass(values, 2.0 * np.pi * cut_off_hz, self.rate_hz, before=values[0])

    def panel(self, title: str, joint: str, rows: slice, *, zero: int = 0, band: bool = False) -> Panel:
        """Return a panel of a joint's truth and estimates in some rows [N m], V1..V3 [N]; time 0 is at row `zero`.

        With `band`, a standard deviation is shown where a method predicts it.
        """
        return self._panel(title, joint, rows, zero, {TRUTH: self.truth, **self.estimates}, band)

    def uncertainty_panel(self, title: str, joint: str, rows: slice, *, zero: int = 0) -> Panel:
        """Return a panel of a joint's uncertainty torque, r - tau_e of (15), and of its predictions [N m].

        A method predicts what it subtracts from the residual; the arguments are those of `panel`.
        """
        shown = {TARGET: self.truth, **self.estimates}
        beyond = {name: self.residual - values for name, values in shown.items()}
        return self._panel(title, joint, rows, zero, beyond, band=True)

    def _panel(
        self, title: str, joint: str, rows: slice, zero: int, shown: Mapping[str, NDArray[Any]], band: bool
    ) -> Panel:
        """Return a panel of a joint in some rows; shown are label -> curves of all joints (T, n) [N m], V1..V3 [N]."""
        k = self.joints.index(joint)
        time = (np.arange(len(self.truth))[rows] - zero) / self.rate_hz
        stds = {name: std[rows, k] for name, std in self.stds.items() if band and std is not None}
        curves = [TorqueCurve(name, values[rows, k], stds.get(name)) for name, values in shown.items()]
        return Panel(title, time, curves, {name: flags[rows] for name, flags in self.flags.items()})


def read_curves(
    layout: JointLayout, runs: Sequence[Run], joints: Sequence[str], flags: Mapping[str, str] | None = None
) -> Curves:
    """Read what runs of several methods made of some joints (n,) of one recording.

    Each flag to read has a name and the column of the recording that says whether it holds.

    Raises:
        ConfigError: a joint is not estimated by a method.
        DataError: a file or a column is missing, or files do not belong together.
    """
    wanted = tuple(joints)
    flags = flags or {}
    pairs = [read_pair(run, layout) for run in runs]
    first = pairs[0]
    return Curves(
        wanted,
        truth=first.truth[:, first.places(wanted)],
        residual=read_array(first.run.residual, named(RESIDUAL, wanted))[0],
        estimates={pair.run.method: pair.estimate[:, pair.places(wanted)] for pair in pairs},
        stds={run.method: read_std(run, wanted) for run in runs},
        flags={name: read_array(first.run.recording, [column])[0][:, 0] > FLAG for name, column in flags.items()},
        spans=first.spans,
        rate_hz=first.rate_hz,
    )


def read_cycle(layout: JointLayout, runs: Sequence[Run], joints: Sequence[str], start_s: float) -> tuple[Curves, slice]:
    """Return what methods made of joints (n,) of a leg, and the rows of the first whole gait cycle after the start.

    Raises:
        DataError: a file is missing or damaged, or no whole cycle follows the start.
        ConfigError: the first joint belongs to no leg.
    """
    curves = read_curves(layout, runs, joints, {"swing": f"{SWING}.{foot_of(layout, joints[0])}"})
    rows = gait_cycle(curves.flags["swing"], curves.spans, round(start_s * curves.rate_hz))
    if rows is None:
        length_s = len(curves.truth) / curves.rate_hz
        raise DataError(f"{runs[0].recording}.parquet: no whole gait cycle after {start_s} s; it lasts {length_s} s")
    return curves, rows


def gait_cycle(air: NDArray[np.bool_], segments: Spans, start: int) -> slice | None:
    """Return the rows from the first lift-off at or after `start` to the next one, or None if there is none.

    Both are within one of the segments (start, end); `air` says whether the foot is planned to be in the air (T,).
    """
    for first, end in segments:
        begin = max(int(first), start)
        if begin >= end:
            continue
        # A swing that is under way in the first row is none that begins: its cycle would lack its beginning.
        lifts = begin + 1 + np.flatnonzero(air[begin + 1 : end] & ~air[begin : end - 1])
        if len(lifts) > 1:
            return slice(int(lifts[0]), int(lifts[1]))
    return None


@dataclass(frozen=True)
class Compared:
    """Truth, or target, and estimates of a joint, and their errors: estimate minus truth [N m], V1..V3 [N].

    `rmse` leads from each estimate, and from `zero`, to the root mean square of its error in the panel [same unit].
    """

    torque: Panel
    error: Panel
    rmse: Mapping[str, float]


def compared(panel: Panel, during: str = "") -> Compared:
    """Return a panel whose first curve is the truth, or the target, with the errors of all other curves.

    An error keeps the standard deviation of its estimate. Where a flag is named, its RMSE is that while the flag holds.
    """
    truth, *estimates = panel.curves
    errors = [TorqueCurve(curve.label, curve.values - truth.values, curve.std) for curve in estimates]
    # An estimate of zero has the torque as its error, up to its sign, of which the RMSE knows nothing.
    shown = {ZERO: truth.values, **{error.label: error.values for error in errors}}
    counted = panel.flags[during].astype(bool) if during else np.ones(len(panel.time), dtype=bool)
    rmse = {
        label: float(np.sqrt(np.mean(values[counted].astype(np.float64) ** 2)))
        for label, values in shown.items()
        if counted.any()
    }
    return Compared(panel, replace(panel, curves=errors), rmse)


def without_zero(runs: Iterable[Run]) -> list[Run]:
    """Return the runs whose estimates are drawn as curves."""
    return [run for run in runs if run.method != ZERO]
