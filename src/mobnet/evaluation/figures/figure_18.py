"""Figure 18: one network a limb against one network for the whole body, errors of the upper body."""

from __future__ import annotations

import logging
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import numpy as np

from mobnet.core.config import load_layout
from mobnet.core.joints import JointLayout
from mobnet.evaluation.figures.drawing.bars import BarPanel, draw_bars
from mobnet.evaluation.figures.style import save_figure
from mobnet.evaluation.measure.scores import AVERAGE
from mobnet.evaluation.number.grid import Wanted, run_grid
from mobnet.evaluation.number.intervals import Summary, mean, summarise
from mobnet.evaluation.number.rows import Score, read_rows, write_rows

log = logging.getLogger(__name__)

UPPER_BODY = "upper body"  # all limbs of the figure together


@dataclass(frozen=True)
class Bar:
    """One error of Figure 18, or of a joint behind it: a row of figure_18.csv.

    Attributes:
        scenario: the test.
        method: estimator.
        limb: limb of section 4.1, or `upper body`.
        joint: joint, or `avg`, the mean over the joints.
        runs: network seeds times test seeds.
        rmse_nm: mean over runs [N m].
        low: lower end of its interval [N m]; None with a single run.
        high: upper end of its interval [N m]; None with a single run.
    """

    scenario: str
    method: str
    limb: str
    joint: str
    runs: int
    rmse_nm: float
    low: float | None
    high: float | None


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
    bars: list[Bar] = []
    panels = []
    for scenario, title in settings["panels"].items():
        rows = read_rows(scores[scenario], Score)
        own = [bar for method in settings["methods"] for bar in method_bars(config, layout, rows, scenario, method)]
        panels.append(panel_of(title, [bar for bar in own if bar.joint == AVERAGE]))
        bars += own
    write_rows(out_dir / "figure_18.csv", Bar, bars)
    save_figure(draw_bars(panels, "RMSE [N m]"), out_dir / "figure_18")
    log.info("%s: %d bars", out_dir / "figure_18.pdf", len(bars))


def method_bars(
    config: Mapping[str, Any], layout: JointLayout, scores: Sequence[Score], scenario: str, method: str
) -> list[Bar]:
    """Return a method's errors [N m]: of the upper body, then limb by limb of the limb and its joints.

    Raises:
        DataError: a run is missing.
    """
    settings = config["evaluation"]["figure_18"]
    grids = {
        limb: [
            run_grid(scores, Wanted(scenario, limb, settings["level"], method, joint)) for joint in layout.limb(limb)
        ]
        for limb in settings["limbs"]
    }
    everything = [grid for limb in grids.values() for grid in limb]
    bars = [Bar(scenario, method, UPPER_BODY, AVERAGE, *_numbers(summarise(everything, config, mean)))]
    for limb, own in grids.items():
        bars.append(Bar(scenario, method, limb, AVERAGE, *_numbers(summarise(own, config, mean))))
        bars += [
            Bar(scenario, method, limb, joint, *_numbers(summarise([grid], config)))
            for joint, grid in zip(layout.limb(limb), own, strict=True)
        ]
    return bars


def _numbers(summary: Summary) -> tuple[int, float, float | None, float | None]:
    """Return the last fields of a bar."""
    return summary.count, summary.value, summary.low, summary.high


def panel_of(title: str, bars: Sequence[Bar]) -> BarPanel:
    """Return a panel: a group for the upper body and for each limb, in each a bar a method [N m]."""
    methods = {
        method: [bar for bar in bars if bar.method == method] for method in dict.fromkeys(b.method for b in bars)
    }
    return BarPanel(
        title,
        list(dict.fromkeys(bar.limb for bar in bars)),
        {method: np.array([bar.rmse_nm for bar in own]) for method, own in methods.items()},
        {method: np.array([_span(bar) for bar in own]).T for method, own in methods.items()},
    )


def _span(bar: Bar) -> tuple[float, float]:
    """Return the ends of a bar's interval [N m], the bar itself where it has none."""
    return (bar.rmse_nm, bar.rmse_nm) if bar.low is None or bar.high is None else (bar.low, bar.high)
