"""Truth, estimates and flags of some joints of a recording, and the panels cut out of them."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mobnet.core.columns import RESIDUAL, STD, named
from mobnet.core.config import load_layout
from mobnet.core.errors import ConfigError, not_accepted
from mobnet.core.files import read_json
from mobnet.core.store import NOTE, read_array
from mobnet.evaluation.measure.metrics import Spans
from mobnet.evaluation.measure.scores import read_pair
from mobnet.evaluation.measure.windows import FLAG

TRUTH, TARGET = "truth", "target"  # labels: tau_e, and what is learned of the uncertainty, r - tau_e (section 4.2.3)


@dataclass(frozen=True)
class Curve:
    """A line over time.

    Attributes:
        label: method or what else is drawn; chooses the look.
        values: torque (T,) [N m], V1..V3 [N].
        std: standard deviation, drawn as a band around the line (T,) [N m], V1..V3 [N]; None for no band.
    """

    label: str
    values: NDArray[Any]
    std: NDArray[Any] | None = None


@dataclass(frozen=True)
class Panel:
    """Curves of one joint over one stretch of time.

    Attributes:
        title: what is shown.
        time: time (T,) [s].
        curves: lines, the last on top.
        flags: name of `FLAGS` -> whether it holds (T,).
    """

    title: str
    time: NDArray[Any]
    curves: Sequence[Curve]
    flags: Mapping[str, NDArray[Any]]


@dataclass(frozen=True)
class Curves:
    """What methods made of some joints of one recording.

    Attributes:
        joints: names, (n,).
        truth: low-passed external torque (T, n) [N m], V1..V3 [N].
        residual: residual of the momentum observer (T, n) [N m], V1..V3 [N].
        estimates: method -> external torque (T, n) [N m], V1..V3 [N].
        stds: method -> standard deviation (T, n) [N m], V1..V3 [N]; None where it tells none.
        flags: name of `figures.FLAGS` -> whether it holds (T,).
        spans: contiguous stretches (start, end) of rows.
        rate_hz: samples per second [Hz].
    """

    joints: tuple[str, ...]
    truth: NDArray[Any]
    residual: NDArray[Any]
    estimates: Mapping[str, NDArray[Any]]
    stds: Mapping[str, NDArray[Any] | None]
    flags: Mapping[str, NDArray[np.bool_]]
    spans: Spans
    rate_hz: float

    def panel(self, title: str, joint: str, rows: slice, *, zero: int = 0, band: bool = False) -> Panel:
        """Return a panel of a joint's truth and estimates [N m], V1..V3 [N].

        Args:
            title: of the panel.
            joint: one of the joints.
            rows: samples shown.
            zero: row at time 0.
            band: whether a standard deviation is shown where a method tells it.
        """
        k = self.joints.index(joint)
        estimates = [
            Curve(method, values[rows, k], self._std(method, rows, k) if band else None)
            for method, values in self.estimates.items()
        ]
        return self._panel(title, rows, zero, [Curve(TRUTH, self.truth[rows, k]), *estimates])

    def uncertainty_panel(self, title: str, joint: str, rows: slice, *, zero: int = 0) -> Panel:
        """Return a panel of a joint's uncertainty torque, r - tau_e of (15), and what was predicted of it [N m].

        What a method takes off the residual is its prediction; the arguments are those of `panel`.
        """
        k = self.joints.index(joint)
        residual = self.residual[rows, k]
        predictions = [
            Curve(method, residual - values[rows, k], self._std(method, rows, k))
            for method, values in self.estimates.items()
        ]
        return self._panel(title, rows, zero, [Curve(TARGET, residual - self.truth[rows, k]), *predictions])

    def _std(self, method: str, rows: slice, k: int) -> NDArray[Any] | None:
        """Return the standard deviation of the k-th joint that a method tells (T,) [N m], V1..V3 [N]."""
        std = self.stds[method]
        return None if std is None else std[rows, k]

    def _panel(self, title: str, rows: slice, zero: int, curves: Sequence[Curve]) -> Panel:
        """Return a panel with time [s] and flags of some rows."""
        time = (np.arange(len(self.truth))[rows] - zero) / self.rate_hz
        return Panel(title, time, curves, {name: flags[rows] for name, flags in self.flags.items()})


def read_curves(
    robot: Path, entries: Sequence[Mapping[str, Any]], joints: Iterable[str], flags: Mapping[str, str] | None = None
) -> Curves:
    """Read what methods made of some joints of a recording.

    Args:
        robot: the robot's table; names the joints that there are.
        entries: a mapping a method, all of one recording: method, and the stems `recording`, `residual`, `estimate`.
        joints: names.
        flags: name of `figures.FLAGS` -> column of the recording that says whether it holds.

    Raises:
        ConfigError: a joint is not estimated by a method.
        DataError: a file or a column is missing, or files do not belong together.
    """
    layout, wanted, flags = load_layout(robot), tuple(joints), flags or {}
    pairs = {entry["method"]: read_pair(Path(entry["estimate"]), Path(entry["residual"]), layout) for entry in entries}
    first = pairs[entries[0]["method"]]
    estimates, stds = {}, {}
    for entry in entries:
        pair = pairs[entry["method"]]
        estimates[entry["method"]] = pair.estimate[:, places_of(wanted, pair.joints, entry["estimate"])]
        stds[entry["method"]] = read_std(Path(entry["estimate"]), wanted)
    residual, _ = read_array(Path(entries[0]["residual"]), named(RESIDUAL, wanted))
    marks = [read_array(Path(entries[0]["recording"]), [column])[0][:, 0] > FLAG for column in flags.values()]
    return Curves(
        wanted, first.truth[:, places_of(wanted, first.joints, "truth")], residual, estimates, stds,
        dict(zip(flags, marks, strict=True)), first.spans, first.rate_hz,
    )  # fmt: skip


def places_of(joints: Sequence[str], held: Sequence[str], where: str) -> list[int]:
    """Return where joints stand among those that a file holds (n,).

    Raises:
        ConfigError: the file holds no such joint.
    """
    for joint in joints:
        if joint not in held:
            raise ConfigError(f"{where}.json: {not_accepted('joint', joint, held)}")
    return [held.index(joint) for joint in joints]


def read_std(estimate: Path, joints: Sequence[str]) -> NDArray[np.float32] | None:
    """Return the standard deviation of joints (T, n) [N m], V1..V3 [N]; None if the file of an estimate has none."""
    held = {column["name"] for column in read_json(estimate.with_suffix(NOTE))["columns"]}
    names = named(STD, joints)
    return read_array(estimate, names)[0] if held.issuperset(names) else None
