"""How much of a push that lasts an estimate shows, over the time since it began, in swing and stance."""

from collections.abc import Sequence
from pathlib import Path

from mobnet.core.columns import DRIFT
from mobnet.evaluation.compare.scene import STANCE, SWINGING
from mobnet.evaluation.figures.drawing.lines import Line, LinePanel, draw_lines
from mobnet.evaluation.figures.style import save_figure
from mobnet.evaluation.measure.estimates.drift import HELD_BIN
from mobnet.evaluation.number.files import Field
from mobnet.evaluation.number.lookup import Lookup, read_lookup
from mobnet.evaluation.number.number import Number
from mobnet.settings.evaluation import Drift, Runs, Statistics

X_LABEL, Y_LABEL = "time since the push began [s]", "share of the push [-]"
Held = dict[float, Number]  # time [s] -> share of the push [-]


def drift(settings: Drift, statistics: Statistics, scores: Sequence[Path], figure_dir: Path) -> None:
    """Write the share of long pushes [-] that each method shows over time [s], as PDF, PNG and CSV."""
    lookup = read_lookup(scores, statistics)
    panels: list[LinePanel] = []
    rows: list[tuple[Field, ...]] = []
    for title, test in settings.tests.items():
        for phase in (SWINGING, STANCE):
            held = {method: held_over_time(lookup, settings, test, method, phase) for method in test.methods}
            lines = [Line(method, list(own), list(own.values())) for method, own in held.items() if own]
            panels.append(LinePanel(f"{title}, {phase}", X_LABEL, Y_LABEL, lines))
            rows += [
                (title, test.scenario, test.level, method, phase, time_s, *number.with_ends, *number.spread)
                for method, own in held.items() for time_s, number in own.items()
            ]  # fmt: skip
    save_figure(draw_lines(panels), figure_dir / "drift", DRIFT, rows)


def held_over_time(lookup: Lookup, settings: Drift, test: Runs, method: str, phase: str) -> Held:
    """Return middle of a bin of time [s] -> share of the push [-], of the bins in which the leg was in a phase."""
    found: Held = {}
    for k in range(round(settings.longest_s / settings.bin_s)):
        number = lookup.average(test, method, settings.limb, HELD_BIN.format(phase, k + 1))
        if number.value is not None:
            found[(k + 0.5) * settings.bin_s] = number
    return found
