"""Score estimates against the low-passed truth: one row a joint, a run and a metric."""

from __future__ import annotations

import logging
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import astuple, dataclass
from itertools import groupby
from math import isnan
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mobnet.core.columns import EXTERNAL, EXTERNAL_LP, SCORES, Score, named
from mobnet.core.config import load_layout
from mobnet.core.errors import DataError
from mobnet.core.files import read_json
from mobnet.core.joints import JointLayout
from mobnet.core.store import NOTE, read_array, spans_and_rate
from mobnet.evaluation.measure.metrics import METRICS, PUSH, PUSHED, Spans
from mobnet.evaluation.measure.windows import push_windows
from mobnet.evaluation.number.files import write_csv

log = logging.getLogger(__name__)

AVERAGE = "avg"


def score(
    config: Mapping[str, Any],
    scenario: str,
    entries: Sequence[Mapping[str, Any]],
    out_csv: Path,
    window: Mapping[str, float] | None = None,
) -> None:
    """Score every run of a scenario and write one CSV.

    The error is `tau_ext` of the estimate minus `tau_ext_lp` of the residual file, the truth behind the observer's
    low-pass (15): what a residual can follow at best (section 5.1, on Figure 6).

    Args:
        config: resolved configuration; names the robot.
        scenario: name that the rows carry.
        entries: one mapping a run: level, method, network_seed, test_seed, and the stems of the files `residual`
            and `estimate`, and `recording` where pushes count.
        out_csv: rows of `columns.Score`.
        window: around pushes, where they count: `before_s` and `after_s` [s].

    Raises:
        DataError: a file is missing or damaged, or estimate and residual do not belong together.
    """
    layout = load_layout(Path(config["robot"]))
    rows = [row for entry in entries for row in score_run(layout, scenario, entry, window)]
    write_csv(out_csv, SCORES, [astuple(row) for row in rows])
    log.info("%s: %d runs, %d rows", out_csv, len(entries), len(rows))


def score_run(
    layout: JointLayout, scenario: str, entry: Mapping[str, Any], window: Mapping[str, float] | None = None
) -> list[Score]:
    """Return the rows of one run: each joint, then the average of each limb, for each metric.

    A metric has no row of a joint that it says nothing about, and none of a push that the run is too short for.

    Raises:
        DataError: a file is missing or damaged, or estimate, residual and recording do not belong together.
    """
    pair = read_pair(Path(entry["estimate"]), Path(entry["residual"]), layout)
    run = (scenario, entry["level"], entry["method"], int(entry["network_seed"]), int(entry["test_seed"]))
    rows: list[Score] = []
    windows = push_windows(Path(entry["recording"]), len(pair.truth), **window) if window else ()
    for metric, numbers, pattern in measured(pair, windows):
        values = {joint: value for joint, value in zip(pair.joints, numbers.tolist(), strict=True) if not isnan(value)}
        for limb, joint, value, unit in limb_values(layout, values):
            rows.append(Score(*run, limb, joint, metric, value, pattern.format(unit)))
    return rows


def measured(pair: Pair, windows: Spans) -> Iterator[tuple[str, NDArray[np.float64], str]]:
    """Yield metric, numbers (n,) [N m, or the metric's unit] and the unit's pattern: of a run, then of its pushes."""
    for metric, (measure, pattern) in METRICS.items():
        yield metric, measure(pair.estimate, pair.truth, pair.spans, pair.rate_hz), pattern
    pushes = {PUSH.format(k): (window,) for k, window in enumerate(windows, start=1)}
    measure, pattern = METRICS["rmse"]
    for metric, spans in ({PUSHED: windows} | pushes if windows else {}).items():
        yield metric, measure(pair.estimate, pair.truth, spans, pair.rate_hz), pattern


def limb_values(layout: JointLayout, values: Mapping[str, float]) -> list[tuple[str, str, float, str]]:
    """Return (limb, joint or `avg`, value, unit) of the joints given, limb by limb.

    The virtual joints have two averages, of N and of N m, as in Table 6.

    Args:
        layout: joints and limbs.
        values: joint -> number [N m], V1..V3 [N].
    """
    rows: list[tuple[str, str, float, str]] = []
    for limb, members in layout.groups.items():
        present = [joint for joint in members if joint in values]
        rows += [(limb, joint, values[joint], layout.unit(joint)) for joint in present]
        for unit, same in groupby(present, key=layout.unit):
            rows.append((limb, AVERAGE, float(np.mean([values[joint] for joint in same])), unit))
    return rows


@dataclass(frozen=True)
class Pair:
    """An estimate and the truth of the same joints and samples.

    Attributes:
        joints: names, (n,).
        estimate: estimated external torque (T, n) [N m], V1..V3 [N].
        truth: low-passed external torque (T, n) [N m], V1..V3 [N].
        spans: contiguous stretches (start, end) of rows.
        rate_hz: samples per second [Hz].
    """

    joints: tuple[str, ...]
    estimate: NDArray[Any]
    truth: NDArray[Any]
    spans: Spans
    rate_hz: float


def read_pair(estimate_stem: Path, residual_stem: Path, layout: JointLayout) -> Pair:
    """Read an estimate and the truth of the same joints, (T, n) [N m].

    Raises:
        DataError: a file is missing or damaged, a column is missing, or rows or segments differ.
    """
    meta, residual_meta = (read_json(stem.with_suffix(NOTE)) for stem in (estimate_stem, residual_stem))
    for key in ("rows", "segments", "rate_hz"):
        if meta[key] != residual_meta[key]:
            raise DataError(
                f"{estimate_stem}.json: {key} is {meta[key]}, but {residual_meta[key]} in {residual_stem}.json"
            )
    held = [column["name"] for column in meta["columns"]]
    joints = tuple(joint for joint in layout.names if f"{EXTERNAL}.{joint}" in held)
    if not joints:
        raise DataError(f"{estimate_stem}.json: no column {EXTERNAL}.<joint>; it holds {', '.join(held)}")
    return Pair(
        joints,
        read_array(estimate_stem, named(EXTERNAL, joints))[0],
        read_array(residual_stem, named(EXTERNAL_LP, joints))[0],
        *spans_and_rate(meta),
    )
