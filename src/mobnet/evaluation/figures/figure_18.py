"""Figure 18: one network a limb against one network for the whole body, errors of the upper body."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from mobnet.core.columns import LIMB_ERRORS, Score
from mobnet.core.config import load_layout
from mobnet.core.joints import JointLayout
from mobnet.evaluation.figures.drawing.bars import BarPanel, draw_bars
from mobnet.evaluation.figures.style import save_figure
from mobnet.evaluation.measure.scores import AVERAGE
from mobnet.evaluation.number.files import read_rows, write_csv
from mobnet.evaluation.number.grid import Wanted, number_of
from mobnet.evaluation.number.number import Number

UPPER_BODY = "upper body"  # all limbs of the figure together

Errors = dict[tuple[str, str], Number]  # limb or UPPER_BODY, joint or AVERAGE -> error [N m]


def figure_18(config: Mapping[str, Any], scores: Mapping[str, Path], out_dir: Path) -> None:
    """Write Figure 18, mean RMSE [N m] over the joints of the upper body and of its limbs, as PDF, PNG and CSV.

    Args:
        config: resolved configuration: `robot`, `seed`, `evaluation.figure_18` (level, limbs, methods, and the title
            of each scenario's panel) and what intervals need.
        scores: scenario -> its scores.
        out_dir: gets figure_18.pdf, .png and .csv.

    Raises:
        DataError: a run that the figure needs is missing.
    """
    layout, settings = load_layout(Path(config["robot"])), config["evaluation"]["figure_18"]
    rows, panels = [], []
    for scenario, title in settings["panels"].items():
        own = read_rows(scores[scenario], Score)
        errors = {method: errors_of(config, layout, own, scenario, method) for method in settings["methods"]}
        panels.append(panel_of(title, errors))
        rows += [
            (scenario, method, *place, error.runs, *error.with_ends)
            for method, found in errors.items() for place, error in found.items()
        ]  # fmt: skip
    write_csv(out_dir / "figure_18.csv", LIMB_ERRORS, rows)
    save_figure(draw_bars(panels, "RMSE [N m]"), out_dir / "figure_18")


def errors_of(
    config: Mapping[str, Any], layout: JointLayout, scores: Sequence[Score], scenario: str, method: str
) -> Errors:
    """Return a method's errors [N m]: of the upper body, then limb by limb of the limb and its joints.

    Raises:
        DataError: a run is missing.
    """
    settings = config["evaluation"]["figure_18"]
    wanted = {
        limb: [Wanted(scenario, limb, settings["level"], method, joint) for joint in layout.limb(limb)]
        for limb in settings["limbs"]
    }
    errors = {(UPPER_BODY, AVERAGE): number_of(scores, [each for own in wanted.values() for each in own], config)}
    for limb, own in wanted.items():
        errors[limb, AVERAGE] = number_of(scores, own, config)
        errors |= {(limb, each.joint): number_of(scores, [each], config) for each in own}
    return errors


def panel_of(title: str, errors: Mapping[str, Errors]) -> BarPanel:
    """Return a panel: a group for the upper body and for each limb, in each a bar a method [N m]."""
    bars = {
        method: {limb: error for (limb, joint), error in own.items() if joint == AVERAGE}
        for method, own in errors.items()
    }
    groups = list(dict.fromkeys(limb for own in bars.values() for limb in own))
    return BarPanel(title, groups, {method: list(own.values()) for method, own in bars.items()})
