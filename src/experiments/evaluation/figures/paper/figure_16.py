"""Figure 16: force and impulse of a fixed obstacle on a foot and on a knee, with the reaction; falls if it is late."""

from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np
import pandas as pd
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from experiments.evaluation.figures.style import LOOKS, beside, entitle, legend, save_figure
from experiments.evaluation.measure.detection.results import MS
from experiments.evaluation.measure.reaction.results import (
    FALLS,
    IMPULSE,
    PEAK,
    SWING,
    in_swing,
    outcome_of,
    printed_of,
    trials_of,
)
from experiments.evaluation.number.frames import read_trials
from experiments.evaluation.number.number import Number
from experiments.evaluation.number.rows import Field
from experiments.plan.reactions import Reactions
from experiments.settings.published import PublishedContacts
from experiments.settings.reaction_tables import Figure16
from experiments.settings.runs import Statistics
from mobnet.core.arrays import Array
from mobnet.core.store import read_array
from mobnet.core.style import styled
from mobnet.settings.reaction import Reaction, watches_of

COLUMNS = ("case", "quantity", "time_s", "value", "low", "high", "unit", "published")
LABELS = {PEAK: "largest force [N]", IMPULSE: "impulse [N s]"}
HEIGHT_INCH = 2.1
MARKERS, COLOURS = "os^v", ("black", "0.55")  # of cases
REACTION = LOOKS["MOB-Net"].colour  # the reaction is that of a method with MOB-Net
BARS = {"all contacts": "0.6", "begun in mid-swing": "0.85"}  # label -> shade, as they stand beside each other
WIDTH = 0.4  # of a bar, where cases are 1 apart
LONG, ROOM = 1.5, 1.1  # an interval that many times as long as the next one is cut; room above the others
APART_MS = 4.0  # so that intervals of two cases do not cover each other


def figure_16(
    settings: Figure16,
    reaction: Reaction,
    statistics: Statistics,
    published: PublishedContacts,
    reactions: Reactions,
    courses: Mapping[str, Path],
    figure_dir: Path,
) -> None:
    """Write Figure 16 as PDF, SVG, PNG and CSV.

    It has the force over time in one walk of each case, means over all walks and over those whose contact began in
    mid-swing, and the share of walks with a fall by how long the reaction waits.
    """
    trials = read_trials(reactions, settings.cases)
    rows = list[Sequence[Field]]()
    forces = dict[str, tuple[Array, Array, Mapping[str, float | None]]]()
    numbers = dict[str, list[Mapping[str, Number]]]()
    for case in settings.cases:
        ours = trials_of(trials, case, reaction.ours)
        titles = case, SWING.format(case)
        numbers[case] = [outcome_of(chosen, settings, statistics) for chosen in (ours, in_swing(ours))]
        forces[case] = force_of(courses[case], settings)
        rows += [
            (case, "force", float(t), float(f), None, None, "N", None) for t, f in zip(*forces[case][:2], strict=True)
        ]
        for title, outcome in zip(titles, numbers[case], strict=True):
            for name in LABELS:
                number = outcome[name]
                rows.append((title, name, None, *number.with_ends, number.unit, printed_of(published, case, name)))
    late = {case: late_falls(trials, case, reaction, settings, statistics) for case in settings.cases}
    for case, by_wait in late.items():
        rows += [(case, "falls", wait_s, *number.with_ends, number.unit, None) for wait_s, number in by_wait.items()]
    save_figure(draw(forces, numbers, late, published), figure_dir / "figure_16", COLUMNS, rows)


def late_falls(
    trials: pd.DataFrame, case: str, reaction: Reaction, settings: Figure16, statistics: Statistics
) -> dict[float, Number]:
    """Return how long our reaction waits [s] -> the share of walks of a case with a fall."""
    falls = dict[float, Number]()
    for watch in sorted(watches_of(reaction, case), key=lambda watch: watch.wait_s):
        of_watch = trials_of(trials, case, watch)
        if len(of_watch) and (watch.detector, watch.rule) == (reaction.ours.detector, reaction.ours.rule):
            falls[watch.wait_s] = outcome_of(of_watch, settings, statistics)[FALLS]
    return falls


def force_of(stem: Path, settings: Figure16) -> tuple[Array, Array, Mapping[str, float | None]]:
    """Return times from the first contact on [s], the obstacle's force [N], and the note of a course.

    Where nothing was touched, the time is that from the beginning.
    """
    force, note = read_array(stem, [f"obstacle.force_{axis}" for axis in "xyz"])
    size = np.linalg.norm(force, axis=1)
    rate_hz = note["rate_hz"]
    first = round((note["contact_s"] or 0.0) * rate_hz)
    start, end = (max(0, first + round(edge * rate_hz)) for edge in settings.shown_s)
    times = (np.arange(len(size)) - first)[start : end : settings.every] / rate_hz
    reacted = note["reacted_s"]
    return (
        times,
        size[start : end : settings.every],
        {"reacted": None if reacted is None else reacted - first / rate_hz},
    )


@styled
def draw(
    forces: Mapping[str, tuple[Array, Array, Mapping[str, float | None]]],
    numbers: Mapping[str, Sequence[Mapping[str, Number]]],
    late: Mapping[str, Mapping[float, Number]],
    published: PublishedContacts,
) -> Figure:
    """Draw each case's force over time, means of each quantity beside the paper's, and falls of late reactions."""
    figure, axes = beside(len(forces) + len(LABELS) + 1, HEIGHT_INCH)
    for k, (axis, (case, (times, force, marks))) in enumerate(zip(axes, forces.items(), strict=False)):
        axis.plot(times, force, color="black", linewidth=0.8)
        if len(times) and (reacted := marks["reacted"]) is not None and reacted <= times[-1]:
            axis.axvline(reacted, color=REACTION, linestyle="--", linewidth=0.9, label="reaction")
        axis.set(xlabel="time from contact [s]", ylabel="force [N]")
        entitle(axis, k, case)
    for k, (axis, (name, label)) in enumerate(
        zip(axes[len(forces) : -1], LABELS.items(), strict=True), start=len(forces)
    ):
        means = {case: [outcome[name] for outcome in outcomes] for case, outcomes in numbers.items()}
        draw_means(axis, means, published, name)
        axis.set(ylabel=label)
        entitle(axis, k, label.partition(" [")[0])
    draw_late(axes[-1], late)
    entitle(axes[-1], len(axes) - 1, "falls")
    legend(figure, axes)
    return figure


def draw_late(axis: Axes, late: Mapping[str, Mapping[float, Number]]) -> None:
    """Draw the share of falls of each case over the time that a reaction waits [ms], with intervals."""
    for k, (case, by_wait) in enumerate(late.items()):
        value, low, high = np.array([number.range for number in by_wait.values()], dtype=np.float64).T
        waits = MS * np.array(list(by_wait)) + k * APART_MS
        look = {
            "marker": MARKERS[k % len(MARKERS)],
            "color": COLOURS[k % len(COLOURS)],
            "markersize": 3,
            "linewidth": 0.8,
            "linestyle": "none",  # few walks at each delay: a line would show a course that nothing was measured of
        }
        axis.errorbar(waits, value, [value - low, high - value], label=case, capsize=2.0, **look)
    axis.set(xlabel="late by [ms]", ylabel="share of walks", ylim=(-0.05, 1.05))


def draw_means(axis: Axes, numbers: Mapping[str, Sequence[Number]], published: PublishedContacts, name: str) -> None:
    """Draw the means of each case with their intervals, one bar for each of BARS, and the paper's as a dot.

    An interval much longer than all others ends at the edge, with its end as text: else nothing else could be read.
    """
    places = np.arange(len(numbers))
    values, lows, highs = np.array(
        [[outcomes[k].range for outcomes in numbers.values()] for k in range(len(BARS))], dtype=np.float64
    ).transpose(2, 0, 1)
    for k, (label, shade) in enumerate(BARS.items()):
        axis.bar(
            places + (k - (len(BARS) - 1) / 2) * WIDTH,
            values[k],
            WIDTH,
            color=shade,
            edgecolor="black",
            linewidth=0.4,
            label=label,
            yerr=[values[k] - lows[k], highs[k] - values[k]],
            error_kw={"linewidth": 0.8, "capsize": 2.0},
        )
    printed = [printed_of(published, case, name) for case in numbers]
    axis.plot(places, [np.nan if value is None else value for value in printed], "kD", markersize=3, label="original")
    axis.set_xticks(places, list(numbers))
    *_, second, longest = sorted(highs[np.isfinite(highs)]) or (0.0, 0.0)
    if longest > LONG * second:
        top = ROOM * second
        axis.set_ylim(0.0, top)
        k, case = np.argwhere(highs == longest)[0]
        place = places[case] + (k - (len(BARS) - 1) / 2) * WIDTH
        axis.annotate(f"to {longest:.0f}", (place, top), (-3.0, 0.0), textcoords="offset points", va="top", ha="right")
