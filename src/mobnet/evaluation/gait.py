"""Figure 5: pick one gait cycle out of a recording and draw it."""

from __future__ import annotations

import logging
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mobnet.core.config import load_layout, read_yaml
from mobnet.core.errors import ConfigError, DataError, not_accepted
from mobnet.core.files import write_text
from mobnet.core.recording import FEET
from mobnet.core.store import read_array
from mobnet.evaluation.figures import Panel, curve_rows, draw_gait_cycle, save_figure
from mobnet.evaluation.metrics import Spans
from mobnet.evaluation.published import read_published
from mobnet.evaluation.rows import csv_text
from mobnet.evaluation.scores import read_pair

log = logging.getLogger(__name__)

SWING = "swing."  # columns of a recording
AIR = 0.5  # a stored flag above this is 1


def figure_05(config: Mapping[str, Any], entries: Sequence[Mapping[str, Any]], out_dir: Path) -> None:
    """Write Figure 5, one gait cycle of one joint [N m], as PDF, PNG and the plotted numbers as CSV.

    Args:
        config: resolved configuration: `evaluation.figure_05` (joint, start_s), `sizes.figure_start_s` instead of
            start_s where a scale is too short for it, `published` for the names of the levels.
        entries: a mapping a panel, in order: level, method, and the stems `recording`, `residual`, `estimate`.
        out_dir: gets figure_05.pdf, .png and .csv.

    Raises:
        DataError: a file is missing or damaged, or no whole cycle follows the start.
        ConfigError: the joint belongs to no leg.
    """
    settings = config["evaluation"]["figure_05"]
    labels = read_published(Path(config["published"]), "table_05")["labels"]
    panels = [read_panel(config, entry, labels.get(entry["level"], entry["level"])) for entry in entries]
    header = ("panel", "time_s", "swing", "truth_nm", "estimate_nm")
    write_text(out_dir / "figure_05.csv", csv_text(header, curve_rows(panels)))
    save_figure(draw_gait_cycle(panels, settings["joint"]), out_dir / "figure_05")
    log.info("%s: %d panels", out_dir / "figure_05.pdf", len(panels))


def read_panel(config: Mapping[str, Any], entry: Mapping[str, Any], label: str) -> Panel:
    """Return one panel: the first whole gait cycle after the start.

    Raises:
        DataError: a file is missing or damaged, or no whole cycle follows the start.
    """
    joint = config["evaluation"]["figure_05"]["joint"]
    start_s = config["sizes"].get("figure_start_s", config["evaluation"]["figure_05"]["start_s"])
    pair = read_pair(Path(entry["estimate"]), Path(entry["residual"]), load_layout(Path(config["robot"])))
    if joint not in pair.joints:
        raise ConfigError(f"{entry['estimate']}.json: " + not_accepted("joint", joint, pair.joints))
    stem = Path(entry["recording"])
    swing, _ = read_array(stem, [SWING + foot_of(Path(config["robot"]), joint)])
    air = swing[:, 0] > AIR
    rows = gait_cycle(air, pair.spans, round(start_s * pair.rate_hz))
    if rows is None:
        raise DataError(f"{stem}.parquet: no whole gait cycle after {start_s} s; it lasts {len(air) / pair.rate_hz} s")
    column = pair.joints.index(joint)
    time = np.arange(rows.stop - rows.start) / pair.rate_hz
    title = f"{entry['method']}, {label[:1].lower()}{label[1:]}"
    return Panel(title, entry["method"], time, air[rows], pair.truth[rows, column], pair.estimate[rows, column])


def gait_cycle(air: NDArray[np.bool_], segments: Spans, start: int) -> slice | None:
    """Return the rows from the first lift-off at or after `start` to the next one within the same segment.

    Args:
        air: whether the foot is planned to be in the air, (T,).
        segments: contiguous stretches (start, end) of rows.
        start: first row looked at.

    Returns:
        Rows of one cycle, or None if there is none.
    """
    for first, end in segments:
        begin = max(int(first), start)
        if begin >= end:
            continue
        lifts = begin + 1 + np.flatnonzero(air[begin + 1 : end] & ~air[begin : end - 1])
        if len(lifts) > 1:
            return slice(int(lifts[0]), int(lifts[1]))
    return None


def foot_of(robot: Path, joint: str) -> str:
    """Return the foot, as named in a recording, of the leg that has a joint.

    Raises:
        ConfigError: the joint belongs to no leg.
    """
    table = read_yaml(robot)
    sides = sorted({foot.split("_")[0] for foot in FEET})
    legs = {side: table["groups"][table["feet"][side]["limb"]] for side in sides}
    for side, joints in legs.items():
        if joint in joints:
            return next(foot for foot in FEET if foot.startswith(side))
    raise ConfigError(f"{robot}: " + not_accepted("leg joint", joint, [name for leg in legs.values() for name in leg]))
