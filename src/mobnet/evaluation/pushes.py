"""Figures 6 and 10: estimates around pushes on a leg, and their errors in the windows that are scored."""

from __future__ import annotations

import logging
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from mobnet.evaluation.curves import read_curves
from mobnet.evaluation.figures import Panel, save_figure, write_panels
from mobnet.evaluation.gait import SWING, foot_of
from mobnet.evaluation.metrics import PUSHED
from mobnet.evaluation.published import published_value, read_published
from mobnet.evaluation.push_errors import ALL, PushError, bar_panel, collision_errors, push_error, wanted_of
from mobnet.evaluation.push_figures import PushGroup, draw_pushes
from mobnet.evaluation.rows import Score, read_rows, write_rows
from mobnet.evaluation.samples import push_windows

log = logging.getLogger(__name__)

ROBOT = "paper (robot)"  # name of numbers that the paper measured on its robot

Entries = Sequence[Mapping[str, Any]]


def figure_06(config: Mapping[str, Any], entries: Entries, scores_csv: Path, out_dir: Path) -> None:
    """Write Figure 6, a step of torque on a swinging hip [N m]: curves around the first, errors in all windows.

    Args:
        config: resolved configuration: `robot`, `published`, `evaluation.figure_06` (scenario, level, methods, joint,
            before_s, after_s) and what intervals need.
        entries: a mapping a method: method, and the stems `recording`, `residual`, `estimate` of one recording.
        scores_csv: scores of the scenario.
        out_dir: gets figure_06.pdf, .png, .csv and figure_06_bars.csv.

    Raises:
        DataError: a file is missing or damaged, or a run is missing.
    """
    settings, scores = config["evaluation"]["figure_06"], read_rows(scores_csv, Score)
    published = read_published(Path(config["published"]), "figure_06")
    joint = settings["joint"]
    errors = [
        push_error(
            config, wanted, ALL, [wanted], scores, published_value(published, wanted.level, wanted.method, joint)
        )
        for wanted in (wanted_of(config, settings, method, joint, PUSHED) for method in settings["methods"])
    ]
    panels = read_pushes(config, settings, entries, f"step {{}} on {joint}")[:1]
    _write([PushGroup(panels, bar_panel("error around the steps", errors))], errors, settings, out_dir / "figure_06")


def figure_10(
    config: Mapping[str, Any], entries: Mapping[str, Entries], scores: Mapping[str, Path], out_dir: Path
) -> None:
    """Write Figure 10, pushes on the knee of a leg in the air and on the ground [N m]: curves and errors of each.

    Args:
        config: resolved configuration: `robot`, `published`, `evaluation.figure_10` (joint, before_s, after_s, tests:
            title -> scenario, level, methods; against: the same of what the average error is compared with) and what
            intervals need.
        entries: title of a test -> a mapping a method, as in Figure 6.
        scores: scenario -> its scores.
        out_dir: gets figure_10.pdf, .png, .csv and figure_10_bars.csv.

    Raises:
        DataError: a file is missing or damaged, or a run is missing.
    """
    settings = config["evaluation"]["figure_10"]
    rows = [row for path in scores.values() for row in read_rows(path, Score)]
    groups, errors = [], []
    for title, test in settings["tests"].items():
        own = collision_errors(config, settings, test, rows)
        panels = read_pushes(config, settings, entries[title], f"{title} {{}}")
        groups.append(PushGroup(panels, bar_panel(f"{title}: error by push", own, ROBOT)))
        errors += own
    _write(groups, errors, settings, out_dir / "figure_10")


def read_pushes(config: Mapping[str, Any], settings: Mapping[str, Any], entries: Entries, title: str) -> list[Panel]:
    """Return a panel for each push of a recording, in order: truth and estimates of a joint [N m], time from the push.

    Args:
        config: resolved configuration: `robot`.
        settings: joint, before_s and after_s [s]: what is shown around a push.
        entries: a mapping a method, all of one recording.
        title: of the panels; the number of the push takes the place of the braces.

    Raises:
        DataError: a file is missing or damaged.
        ConfigError: the joint belongs to no leg, or is not estimated.
    """
    robot, joint = Path(config["robot"]), settings["joint"]
    curves = read_curves(robot, entries, [joint], {"swing": SWING + foot_of(robot, joint), "push": "pushed"})
    recording = Path(entries[0]["recording"])
    windows = push_windows(recording, len(curves.truth), settings["before_s"], settings["after_s"])
    panels = []
    for k, (start, end) in enumerate(windows, start=1):
        zero = start + int(np.argmax(curves.flags["push"][start:end]))
        panels.append(curves.panel(title.format(k), joint, slice(start, end), zero=zero))
    return panels


def _write(groups: Sequence[PushGroup], errors: Sequence[PushError], settings: Mapping[str, Any], stem: Path) -> None:
    """Write curves and errors [N m] as CSV, and the figure."""
    across, note_deg = (1, 0) if len(groups) == 1 else (2, 90)
    write_panels(stem.with_suffix(".csv"), [panel for group in groups for panel in group.panels])
    write_rows(stem.with_name(f"{stem.name}_bars.csv"), PushError, errors)
    save_figure(draw_pushes(groups, settings["joint"], across, note_deg), stem)
    log.info("%s.pdf: %d errors", stem, len(errors))
