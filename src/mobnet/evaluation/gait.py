"""Figures 5, 8 and 9: pick one gait cycle out of a recording and draw joints of the leg that begins it."""

from __future__ import annotations

import logging
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mobnet.core.config import load_layout, read_yaml
from mobnet.core.errors import ConfigError, DataError, not_accepted
from mobnet.core.recording import FEET
from mobnet.evaluation.curves import Curves, read_curves
from mobnet.evaluation.figures import Panel, draw_panels, save_figure, write_panels
from mobnet.evaluation.metrics import Spans, rmse_in_spans
from mobnet.evaluation.published import read_published

log = logging.getLogger(__name__)

SWING = "swing."  # columns of a recording
FROM_LIFT_OFF = "time from lift-off [s]"
SIDE_BY_SIDE, HEIGHT_INCH = 3, 1.5  # panels of a leg's joints

Entries = Sequence[Mapping[str, Any]]


def figure_05(config: Mapping[str, Any], entries: Entries, out_dir: Path) -> None:
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
    y_label = f"external torque of {settings['joint']} [N m]"
    write_panels(out_dir / "figure_05.csv", panels)
    save_figure(draw_panels(panels, FROM_LIFT_OFF, y_label, one_scale=True), out_dir / "figure_05")
    log.info("%s: %d panels", out_dir / "figure_05.pdf", len(panels))


def read_panel(config: Mapping[str, Any], entry: Mapping[str, Any], label: str) -> Panel:
    """Return one panel of Figure 5: the first whole gait cycle after the start.

    Raises:
        DataError: a file is missing or damaged, or no whole cycle follows the start.
    """
    settings = config["evaluation"]["figure_05"]
    curves, rows = read_cycle(config, settings, [entry], [settings["joint"]])
    title = f"{entry['method']}, {label[:1].lower()}{label[1:]}"
    return curves.panel(title, settings["joint"], rows, zero=rows.start)


def figure_08(config: Mapping[str, Any], entries: Entries, out_dir: Path) -> None:
    """Write Figure 8, uncertainty torque of a leg over one gait cycle [N m]: the target and what a network predicts.

    The error told in a panel's title is that over the whole recording, as the paper tells it.

    Args:
        config: resolved configuration: `robot`, `evaluation.figure_08` (limb, start_s), `sizes.figure_start_s`.
        entries: a mapping a method: method, and the stems `recording`, `residual`, `estimate` of one recording.
        out_dir: gets figure_08.pdf, .png and .csv.

    Raises:
        DataError: a file is missing or damaged, or no whole cycle follows the start.
    """
    curves, rows = read_leg(config, "figure_08", entries)
    (estimate,) = curves.estimates.values()
    errors = rmse_in_spans(estimate, curves.truth, curves.spans, curves.rate_hz).tolist()
    panels = [
        curves.uncertainty_panel(f"{joint}, RMSE {error:.2f} N m", joint, rows, zero=rows.start)
        for joint, error in zip(curves.joints, errors, strict=True)
    ]
    _write(panels, "uncertainty torque [N m]", out_dir / "figure_08")


def figure_09(config: Mapping[str, Any], entries: Entries, out_dir: Path) -> None:
    """Write Figure 9, external torque of a leg over one gait cycle by method [N m].

    Args:
        config: resolved configuration: `robot`, `evaluation.figure_09` (limb, start_s), `sizes.figure_start_s`.
        entries: a mapping a method: method, and the stems `recording`, `residual`, `estimate` of one recording.
        out_dir: gets figure_09.pdf, .png and .csv.

    Raises:
        DataError: a file is missing or damaged, or no whole cycle follows the start.
    """
    curves, rows = read_leg(config, "figure_09", entries)
    panels = [curves.panel(joint, joint, rows, zero=rows.start) for joint in curves.joints]
    _write(panels, "external torque [N m]", out_dir / "figure_09")


def _write(panels: Sequence[Panel], y_label: str, stem: Path) -> None:
    """Write a leg's panels [N m] as CSV, PDF and PNG."""
    write_panels(stem.with_suffix(".csv"), panels)
    save_figure(draw_panels(panels, FROM_LIFT_OFF, y_label, SIDE_BY_SIDE, height_inch=HEIGHT_INCH), stem)
    log.info("%s.pdf: %d panels", stem, len(panels))


def read_leg(config: Mapping[str, Any], figure: str, entries: Entries) -> tuple[Curves, slice]:
    """Return `read_cycle` of all joints of the limb that a figure names, (n,)."""
    settings = config["evaluation"][figure]
    return read_cycle(config, settings, entries, load_layout(Path(config["robot"])).limb(settings["limb"]))


def read_cycle(
    config: Mapping[str, Any], settings: Mapping[str, Any], entries: Entries, joints: Sequence[str]
) -> tuple[Curves, slice]:
    """Return what methods made of joints of a leg, and the rows of the first whole gait cycle after the start.

    Args:
        config: resolved configuration: `robot`, `sizes.figure_start_s` instead of start_s where it is given.
        settings: start_s [s].
        entries: a mapping a method, all of one recording.
        joints: names.

    Raises:
        DataError: a file is missing or damaged, or no whole cycle follows the start.
        ConfigError: the first joint belongs to no leg.
    """
    robot, start_s = Path(config["robot"]), config["sizes"].get("figure_start_s", settings["start_s"])
    curves = read_curves(robot, entries, joints, {"swing": SWING + foot_of(robot, joints[0])})
    rows = gait_cycle(curves.flags["swing"], curves.spans, round(start_s * curves.rate_hz))
    if rows is None:
        length_s = len(curves.truth) / curves.rate_hz
        raise DataError(
            f"{entries[0]['recording']}.parquet: no whole gait cycle after {start_s} s; it lasts {length_s} s"
        )
    return curves, rows


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
