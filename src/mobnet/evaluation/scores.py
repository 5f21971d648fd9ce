"""Score estimates against the low-passed truth: one row a joint, a run and a metric."""

from __future__ import annotations

import logging
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from itertools import groupby
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mobnet.core.config import load_layout
from mobnet.core.errors import DataError
from mobnet.core.files import read_json
from mobnet.core.joints import JointLayout
from mobnet.core.store import NOTE, read_array
from mobnet.evaluation.metrics import METRICS, Spans
from mobnet.evaluation.rows import Score, write_rows

log = logging.getLogger(__name__)

AVERAGE = "avg"
ESTIMATE = "tau_ext."  # columns of an estimate file
TRUTH = "tau_ext_lp."  # columns of a residual file


def score(config: Mapping[str, Any], scenario: str, entries: Sequence[Mapping[str, Any]], out_csv: Path) -> None:
    """Score every run of a scenario and write one CSV.

    The error is `tau_ext` of the estimate minus `tau_ext_lp` of the residual file, the truth behind the observer's
    low-pass (15): what a residual can follow at best (section 5.1, on Figure 6).

    Args:
        config: resolved configuration; names the robot.
        scenario: name that the rows carry.
        entries: one mapping a run: level, method, network_seed, test_seed, and the stems of the files `residual`
            and `estimate`.
        out_csv: rows of `rows.Score`.

    Raises:
        DataError: a file is missing or damaged, or estimate and residual do not belong together.
    """
    layout = load_layout(Path(config["robot"]))
    rows = [row for entry in entries for row in score_run(layout, scenario, entry)]
    write_rows(out_csv, Score, rows)
    log.info("%s: %d runs, %d rows", out_csv, len(entries), len(rows))


def score_run(layout: JointLayout, scenario: str, entry: Mapping[str, Any]) -> list[Score]:
    """Return the rows of one run: each joint, then the average of each limb, for each metric.

    Raises:
        DataError: a file is missing or damaged, or estimate and residual do not belong together.
    """
    pair = read_pair(Path(entry["estimate"]), Path(entry["residual"]), layout)
    run = (scenario, entry["level"], entry["method"], int(entry["network_seed"]), int(entry["test_seed"]))
    rows: list[Score] = []
    for metric, (measure, per) in METRICS.items():
        numbers = measure(pair.estimate, pair.truth, pair.spans, pair.rate_hz)
        values = dict(zip(pair.joints, numbers.tolist(), strict=True))
        for limb, joint, value, unit in limb_values(layout, values):
            rows.append(Score(*run, limb, joint, metric, value, unit + per))
    return rows


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
    joints = tuple(joint for joint in layout.names if ESTIMATE + joint in held)
    if not joints:
        raise DataError(f"{estimate_stem}.json: no column {ESTIMATE}<joint>; it holds {', '.join(held)}")
    return Pair(
        joints,
        read_array(estimate_stem, [ESTIMATE + joint for joint in joints])[0],
        read_array(residual_stem, [TRUTH + joint for joint in joints])[0],
        tuple((int(start), int(end)) for start, end in meta["segments"]),
        float(meta["rate_hz"]),
    )
