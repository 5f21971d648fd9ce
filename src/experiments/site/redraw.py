"""Published figures as SVG and PDF, drawn from the CSVs in docs/results alone: `./reproduce draw`.

The folder holds PNG: SVG and PDF of every run would make the repository large. A few figures show more than their CSV
has, such as the robot's pose or the single runs behind a mean; a run makes those.
"""

import gzip
import logging
import sys
import tempfile
from collections.abc import Callable, Mapping, Sequence
from functools import partial
from itertools import product
from pathlib import Path
from typing import Any

import numpy as np
import pandas as pd
from matplotlib.figure import Figure

from experiments.evaluation.compare.curves import TARGET, TRUTH, Compared, Panel, TorqueCurve, compared
from experiments.evaluation.compare.scene import STANCE, SWINGING
from experiments.evaluation.figures.drawing.compared import (
    bars_of,
    draw_columns,
    draw_leg,
    draw_relative_columns,
    draw_stack,
)
from experiments.evaluation.figures.drawing.curves import FROM_LIFT_OFF
from experiments.evaluation.figures.drawing.lines import LinePanel, draw_lines
from experiments.evaluation.figures.drawing.method_and_robot import LIMBS, draw_method, draw_parts, position_of
from experiments.evaluation.figures.drawing.named_bars import PAPER_LABEL, NamedBar
from experiments.evaluation.figures.drawing.pushes import draw_hits, draw_step
from experiments.evaluation.figures.further import (
    bode,
    commands,
    detection_curves,
    drift,
    fine_tuning,
    forest,
    learning_curve,
    reliability,
    sigma_courses,
)
from experiments.evaluation.figures.paper import (
    figure_05,
    figure_06,
    figure_08,
    figure_09,
    figure_10,
    figure_14,
    figure_15,
    figure_18,
    figure_19,
    figure_20,
    hand_figure,
)
from experiments.evaluation.figures.style import save_picture
from experiments.evaluation.measure.claims.places import statements_of
from experiments.evaluation.measure.data.conditional import TorqueRange, even_cells
from experiments.evaluation.measure.data.planes import Plane
from experiments.evaluation.measure.estimates.bode import observer_response
from experiments.evaluation.number.frames import rows_of
from experiments.evaluation.number.laws import numbers_by
from experiments.evaluation.number.number import Number
from experiments.evaluation.report import calibration, claims, sigma
from experiments.plan.products import all_items
from experiments.records.trial_errors import TrialError
from experiments.running.words import draw_parser
from experiments.settings.load import load_settings
from experiments.settings.settings import Settings
from experiments.settings.table_columns import SPREAD
from experiments.site.judge_again import judged_again
from experiments.site.snapshot import DRAWN, SNAPSHOT, run_renewal
from mobnet.core.columns import COMMAND
from mobnet.core.errors import ConfigError, DataError, not_accepted
from mobnet.core.rows import read_rows
from mobnet.core.style import styled
from mobnet.robot.description import describe, dressed

log = logging.getLogger(__name__)
ENDINGS = (".svg", ".pdf")
OUT = Path("results/drawn")
Frame = Any  # of pandas, whose types say of a group only that it is some frame or series
STD = " std"  # ends the name of a column with the standard deviation of another one


class Stored:
    """What figures are drawn from: the CSVs in a folder of published results, and how figures look."""

    def __init__(self, results: Path, settings: Settings) -> None:
        """Take the folder, and the settings with what is shown."""
        self.results = results
        self._folder = results / DRAWN
        self.settings = settings

    def section(self, name: str) -> Any:
        """Return the section of the configuration that says what a figure shows."""
        return getattr(self.settings.evaluation, name)

    def path(self, name: str) -> Path:
        """Return the file of a figure's numbers; a DataError says that there is none."""
        path = self._folder / f"{name}.csv.gz"
        if not path.is_file():
            raise DataError(f"{path}: file is missing; ./reproduce snapshot stores it")
        return path

    def rows(self, name: str) -> Frame:
        """Return a figure's numbers as they are published."""
        return pd.read_csv(self.path(name), dtype=dict.fromkeys(SPREAD[:2], str))  # 3, or 3+3


def panels_of(rows: Frame) -> list[Panel]:
    """Return the panels of curves over time; columns between the time and the first curve are flags."""
    names = list(rows.columns)
    first = min(names.index(name) for name in (TRUTH, TARGET) if name in names)
    labels = [name for name in names[first:] if not name.endswith(STD)]
    panels: list[Panel] = []
    for title, own in rows.groupby("panel", sort=False):
        curves: list[TorqueCurve] = []
        for label in labels:
            # A curve that only another panel has is empty here.
            if own[label].notna().any():
                has_band = label + STD in names and own[label + STD].notna().any()
                std = own[label + STD].to_numpy() if has_band else None
                curves.append(TorqueCurve(label, own[label].to_numpy(), std))
        flags = {name: own[name].to_numpy() > 0 for name in names[2:first]}
        panels.append(Panel(str(title), own["time_s"].to_numpy(), curves, flags))
    return panels


def pairs_of(rows: Frame, during: str = "") -> dict[str, Compared]:
    """Return title -> curves of a panel with their errors, counted while a flag holds."""
    return {panel.title: compared(panel, during) for panel in panels_of(rows)}


def errors_of(stored: Stored, name: str, metric: str) -> dict[str, dict[str, Number]]:
    """Return joint or limb -> method -> error in the bars of a figure."""
    rows = stored.rows(f"{name}_bars")
    own = rows[rows["metric"] == metric]
    return {joint: numbers_by(of, "method") for joint, of in own.groupby("joint", sort=False)}


def draw_05(stored: Stored, name: str) -> Figure:
    """Draw one gait cycle of a joint at each level."""
    settings = stored.section(name)
    rows = stored.rows(f"{name}_bars")
    pairs = pairs_of(stored.rows(name))
    bars: list[NamedBar] = []
    for level, own in rows.groupby("level", sort=False):
        title = str(level).replace("_", " ")
        short = f", {title}" if len(own) == 1 else ""
        for bar in bars_of(numbers_by(own, "method"), pairs[title].rmse):
            bars.append(NamedBar(bar.name + short, bar.method, bar.number, bar.marks))
    return draw_stack(list(pairs.values()), bars, settings.errors_of, "RMSE over all walks", settings.joint)


def draw_06(stored: Stored, name: str) -> Figure:
    """Draw a step of torque on a hip."""
    joint = stored.section(name).joint
    panels = panels_of(stored.rows(name))
    (errors,) = (numbers_by(own, "method") for _, own in stored.rows(f"{name}_bars").groupby("joint"))
    return draw_step(panels, bars_of(errors, compared(panels[0]).rmse), joint, "RMSE around all steps")


def draw_08(stored: Stored, name: str) -> Figure:
    """Draw the uncertainty torque of a leg."""
    settings = stored.section(name)
    (method,) = settings.methods
    errors = errors_of(stored, name, settings.metric)
    pairs = pairs_of(stored.rows(name))
    return draw_leg([figure_08.entitled(pair, method, errors[joint][method]) for joint, pair in pairs.items()])


def draw_09(stored: Stored, name: str) -> Figure:
    """Draw a leg by method."""
    settings = stored.section(name)
    errors = errors_of(stored, name, settings.metric)
    pairs = pairs_of(stored.rows(name))
    return draw_columns(
        [pairs[joint] for joint in settings.drawn],
        [bars_of(errors[joint], pairs[joint].rmse) for joint in settings.drawn],
        [stored.settings.layout.unit(joint) for joint in settings.drawn],
        settings.errors_of,
        FROM_LIFT_OFF,
        PAPER_LABEL[stored.settings.published.tables[settings.table].robot],
    )


def draw_hand(stored: Stored, name: str) -> Figure:
    """Draw a hand that is loaded or pushed."""
    settings = stored.section(name)
    layout = stored.settings.layout
    pairs = list(pairs_of(stored.rows(name), settings.called).values())
    errors = errors_of(stored, name, hand_figure.RELATIVE.format(settings.metric, "zero"))
    limbs = [hand_figure.limb_of(layout, joint)[0] for joint in settings.joints]
    bars = [bars_of(errors[limb], {}) for limb in limbs]
    units = [layout.unit(joint) for joint in settings.joints]
    return draw_relative_columns(pairs, bars, units, settings.errors_of, "time [s]", limbs)


def draw_10(stored: Stored, name: str) -> Figure:
    """Draw hits of a knee: those of the first test of the section, in the air, or of the second, on the ground."""
    settings = stored.section(figure_10.PICTURES[0])
    title, test = list(settings.tests.items())[figure_10.PICTURES.index(name)]
    rows = stored.rows(f"{figure_10.PICTURES[0]}_bars")
    own = rows[rows["scenario"] == test.scenario]
    group = figure_10.group_of(panels_of(stored.rows(name)), title, own)
    return draw_hits(group, settings.joint, PAPER_LABEL[True])


def draw_14(stored: Stored, name: str) -> Figure:
    """Draw histograms of collisions; of each bin its middle, as often as it was counted."""
    rows = stored.rows(name)
    found: dict[str, dict[str, Any]] = {}
    edges: dict[str, Any] = {}
    for (level, quantity), own in rows.groupby(["level", "quantity"], sort=False):
        middles = (own["bin_from"] + own["bin_to"]) / 2.0
        found.setdefault(str(level), {})[str(quantity)] = np.repeat(middles.to_numpy(), own["count"])
        edges[str(quantity)] = np.array([*own["bin_from"], own["bin_to"].iloc[-1]])
    printed = rows.dropna(subset="published").groupby("quantity")["published"].first()
    return figure_14.draw_histograms(found, edges, printed.to_dict())


def draw_15(stored: Stored, name: str) -> Figure:
    """Draw standard deviations at collisions."""
    return figure_15.draw_courses(stored.rows(name), stored.section(name).joint)


def draw_18(stored: Stored, name: str) -> Figure:
    """Draw one network for the whole body beside one for each limb."""
    rows = stored.rows(name).rename(columns={"rmse_nm": "value"})
    return figure_18.draw_limbs(rows, stored.section(name).panels, "RMSE [N m]")


def draw_20(stored: Stored, name: str) -> Figure:
    """Draw errors over the size of the network and of the data."""
    return draw_lines(figure_20.panels_of(stored.rows(name)))


def draw_bode(stored: Stored, name: str) -> Figure:
    """Draw gain and phase over frequency."""
    rows = stored.rows(name)
    gain_hz = stored.settings.observer.gain_hz
    response = partial(observer_response, gain_hz=gain_hz, rate_hz=stored.settings.rates.data_hz)
    inch = bode.SHOWN_INCH if name == bode.bode.__name__ else bode.ALL_INCH
    return bode.draw_bode(rows, list(rows["joint"].unique()), response, inch)


def draw_calibration(stored: Stored, name: str) -> Figure:
    """Draw the reliability diagram."""
    settings = stored.section(name)
    rows = stored.rows(name).rename(columns={"limb": "name"})
    rows["curve"] = rows.groupby(["case", "method", "name"], sort=False).ngroup()
    limb = rows["name"].str.partition(" ")[0]  # that of the base comes with the unit
    return reliability.draw_reliability(rows[limb.isin(settings.drawn)], settings.tolerance)


def draw_commands(stored: Stored, name: str) -> Figure:
    """Draw the commands of the first training set."""
    rows = stored.rows(name)
    own = rows[rows["set"] == rows["set"].iloc[0]]
    panels: list[commands.Bars] = []
    for column, label in enumerate(commands.LABELS):
        of = own[own["command"] == COMMAND[column][0]]
        edges = np.array([*of["bin_from"], of["bin_to"].iloc[-1]])
        named = commands.named_values(stored.settings.commands, column)
        panels.append(commands.Bars(label, edges, 100.0 * of["share"].to_numpy(), named))
    return commands.draw_bars(panels)


def draw_drift(stored: Stored, name: str) -> Figure:
    """Draw pushes that last."""
    rows = stored.rows(name).rename(columns={"share": "value"})
    panels: list[LinePanel] = []
    for title, phase in product(rows["panel"].unique(), (SWINGING, STANCE)):
        panels.append(drift.panel_of(f"{title}, {phase}", rows_of(rows, panel=title, phase=phase)))
    return draw_lines(panels, min(drift.COLUMNS, len(panels)), drift.PANEL_INCH)


def draw_fine_tuning(stored: Stored, name: str) -> Figure:
    """Draw errors over the seconds of new data."""
    panels: list[LinePanel] = []
    for title, rows in stored.rows(name).groupby("panel", sort=False):
        panels.append(fine_tuning.panel_of(str(title), rows))
    return draw_lines(panels, min(fine_tuning.COLUMNS, len(panels)), fine_tuning.PANEL_INCH)


def draw_learning_curve(stored: Stored, name: str) -> Figure:
    """Draw errors over the length of the training."""
    with tempfile.NamedTemporaryFile(suffix=".csv") as file:
        plain = Path(file.name)
        plain.write_bytes(gzip.decompress(stored.path(name).read_bytes()))
        rows = read_rows(plain, TrialError)
    tasks: dict[str, list[TrialError]] = {}
    for row in rows:
        tasks.setdefault(row.task, []).append(row)
    return learning_curve.draw_learning(stored.section(name), tasks)


def draw_sigma(stored: Stored, name: str) -> Figure:
    """Draw predicted standard deviations in parts of a walk."""
    return sigma_courses.draw_sigma(stored.rows(name), stored.settings.learning.calibration_share)


@styled
def draw_blocks(stored: Stored, name: str) -> Figure:
    """Draw the method as blocks, which has no number."""
    limbs = stored.settings.evaluation.drawings.limbs
    return draw_method([limb for limb in LIMBS if limb in limbs])[0]


def draw_19(stored: Stored, name: str) -> Figure:
    """Draw the ranges of torque by phase."""
    rows = stored.rows(name)
    phases = stored.section("coverage").phases
    cells = even_cells([(0.0, 1.0)], [phases])
    edges = (np.zeros(0), np.zeros(0))  # of the plane, which is not drawn
    planes: list[Plane] = []
    for joint, own in rows.groupby("joint", sort=False):
        inside = own[own["kind"] == "plane"]
        places = [inside["from"], inside["torque_from_nm"]]
        # Cells that a set does not visit are no rows of it.
        shares = inside["share_percent"].groupby([*places, inside["set"]]).sum().unstack(fill_value=0.0)
        ranges: dict[str, TorqueRange] = {}
        for samples, of in own[own["kind"] == "phase"].groupby("set", sort=False):
            ends = np.full((2, phases), np.nan)
            ends[:, np.round(of["from"] * phases).astype(int)] = of[["torque_from_nm", "torque_to_nm"]].T
            ranges[str(samples)] = TorqueRange(cells, *ends)
        planes.append(Plane(str(joint), edges, {each: shares[each].to_numpy() for each in ranges}, ranges))
    return figure_19.draw_ranges(planes)


def draw_detection(stored: Stored, name: str) -> Figure:
    """Draw detection against false alarms and force."""
    return detection_curves.draw_courses(stored.rows(name))


def draw_claims(stored: Stored, name: str) -> Figure:
    """Draw statements by their worst claim, as the published tables have them."""
    settings = stored.settings
    statements = statements_of(judged_again(settings, stored.results))
    axis = next(axis for axis, stem in forest.STEMS.items() if stem == name)
    confidence = settings.evaluation.statistics.confidence
    return forest.draw_forest(rows_of(statements, axis=axis), axis, f"{confidence:.0%} interval")


@styled
def draw_robot(stored: Stored, name: str) -> Figure:
    """Draw the robot, whose places are those of its table."""
    settings = stored.settings
    own = stored.settings.evaluation.drawings
    shown = dressed(describe(settings.robot), settings.robot.looks)
    push = settings.pushes[stored.settings.evaluation.story.push]
    return draw_parts(own, shown, position_of(own, settings.robot, settings.layout), push)[0]


# What makes a figure in a run -> what draws it from its CSV.
BY_FUNCTION: Mapping[Callable[..., None], Callable[[Stored, str], Figure]] = {
    figure_05.figure_05: draw_05,
    figure_06.figure_06: draw_06,
    hand_figure.hand_figure: draw_hand,
    figure_08.figure_08: draw_08,
    figure_09.figure_09: draw_09,
    figure_10.figure_10: draw_10,
    figure_14.figure_14: draw_14,
    figure_15.figure_15: draw_15,
    figure_18.figure_18: draw_18,
    figure_19.figure_19: draw_19,
    figure_20.figure_20: draw_20,
    bode.bode: draw_bode,
    calibration.calibration: draw_calibration,
    claims.claims: draw_claims,
    commands.commands: draw_commands,
    detection_curves.detection_curves: draw_detection,
    drift.drift: draw_drift,
    fine_tuning.fine_tuning: draw_fine_tuning,
    learning_curve.learning_curve: draw_learning_curve,
    sigma.sigma: draw_sigma,
}
DRAWINGS: Mapping[str, Callable[[Stored, str], Figure]] = {"method": draw_blocks, "robot": draw_robot}  # of no number


def drawn_from_csv() -> dict[str, Callable[[Stored, str], Figure]]:
    """Return the names of the figures that can be drawn -> what draws them."""
    found = dict(DRAWINGS)
    for item in all_items():
        if draw := BY_FUNCTION.get(item.late()) if item.figure else None:
            found |= dict.fromkeys(item.pictures, draw)
    return found


def redraw(stored: Stored, names: Sequence[str], out: Path) -> None:
    """Draw published figures, all that can be if none is named, as SVG and PDF into a folder.

    Raises:
        ConfigError: a name is that of no figure whose CSV has all that is drawn.
        DataError: a file is missing or damaged.
    """
    known = drawn_from_csv()
    for name in names:
        if name not in known:
            fault = not_accepted("figure", name, known)
            raise ConfigError(f"{fault}; ./reproduce figures/{name}.pdf makes it in a run")
    out.mkdir(parents=True, exist_ok=True)
    for name in names or known:
        save_picture(known[name](stored, name), out / name, ENDINGS)
        log.info("%s", " ".join(str(out / f"{name}{ending}") for ending in ENDINGS))


def main(words: Sequence[str]) -> int:
    """Run the command; return its exit status."""
    options = draw_parser().parse_args(words)
    # Claims that the published tables have no number of are drawn so.
    logging.getLogger("experiments.evaluation.measure.claims").setLevel(logging.ERROR)
    return run_renewal(lambda: redraw(Stored(SNAPSHOT, load_settings()), options.figures, options.out or OUT), log)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
