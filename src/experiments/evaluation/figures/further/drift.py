"""How much of a push that lasts an estimate shows, step by step since it began, in swing and stance."""

from collections.abc import Mapping, Sequence
from pathlib import Path

from experiments.evaluation.compare.scene import STANCE, SWINGING
from experiments.evaluation.figures.drawing.lines import Line, LinePanel, draw_lines
from experiments.evaluation.figures.style import save_figure
from experiments.evaluation.measure.estimates.drift import HELD_STEP
from experiments.evaluation.number.grid import Lookup, read_lookup
from experiments.evaluation.number.number import Number
from experiments.evaluation.number.rows import Field
from experiments.settings.measures import Drift
from experiments.settings.runs import Runs, Statistics
from experiments.settings.table_columns import DRIFT

X_LABEL = "number of the step since the push began"
Y_LABEL = "share of the push [-]"
ENDS = (0.0, 1.3)  # of the axis
COLUMNS, PANEL_INCH, APART = 4, 2.0, 0.07  # panels in a row, their height, distance of marks at a step
Held = Mapping[int, Number]  # number of the step -> share of the push [-]


def drift(settings: Drift, statistics: Statistics, scores: Sequence[Path], figure_dir: Path) -> None:
    """Write the share of long pushes [-] that each method shows, step by step, as PDF, PNG and CSV."""
    lookup = read_lookup(scores, statistics)
    panels: list[LinePanel] = []
    rows: list[tuple[Field, ...]] = []
    for title, test in settings.tests.items():
        for phase in (SWINGING, STANCE):
            held = {method: held_by_step(lookup, settings, test, method, phase) for method in test.methods}
            panels.append(panel_of(f"{title}, {phase}", held))
            for method, own in held.items():
                place = title, test.scenario, test.level, method, phase
                rows += [(*place, step, *number.with_ends, *number.spread) for step, number in own.items()]
    figure = draw_lines(panels, min(COLUMNS, len(panels)), PANEL_INCH)
    save_figure(figure, figure_dir / "drift", DRIFT, rows)


def panel_of(title: str, held: Mapping[str, Held]) -> LinePanel:
    """Return the panel of a phase: a line for each method that has a share there."""
    lines = [Line(method, list(own), list(own.values())) for method, own in held.items() if own]
    return LinePanel(
        title,
        X_LABEL,
        Y_LABEL,
        lines,
        guide=1.0,
        ends=ENDS,
        note=beyond(held),
        logarithmic=False,
        dodge=APART,
    )


def held_by_step(lookup: Lookup, settings: Drift, test: Runs, method: str, phase: str) -> Held:
    """Return number of a step -> share of the push [-], of the steps that the pushes have."""
    numbers = {
        step: lookup.average(test, method, settings.limb, HELD_STEP.format(phase, step))
        for step in range(1, settings.steps + 1)
    }
    return {step: number for step, number in numbers.items() if number.value is not None}


def beyond(held: Mapping[str, Held]) -> str:
    """Return the shares outside of the axis, a line for each method."""
    texts = []
    for method, own in held.items():
        outside = [number.value for number in own.values() if number.value is not None and not inside(number.value)]
        if outside:
            texts.append(f"beyond: {method} {', '.join(f'{value:.2f}' for value in outside)}")
    return "\n".join(texts)


def inside(share: float) -> bool:
    """Return whether a share [-] lies on the axis."""
    return ENDS[0] <= share <= ENDS[1]
