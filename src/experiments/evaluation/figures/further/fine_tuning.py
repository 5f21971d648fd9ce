"""Fine-tuning to a changed robot (section 8.2): error over the seconds of new data."""

from collections.abc import Mapping, Sequence
from pathlib import Path

from experiments.evaluation.figures.drawing.lines import Line, LinePanel, draw_lines
from experiments.evaluation.figures.style import save_figure
from experiments.evaluation.number.grid import Wanted, number_of
from experiments.evaluation.number.number import Number
from experiments.evaluation.number.rows import read_scores
from experiments.settings.figures import FineTuning, TunedTest
from experiments.settings.runs import Statistics
from experiments.settings.table_columns import TUNED
from mobnet.settings.methods import swept_name

BEFORE = "not fine-tuned"
KNOWN = "on its own robot"
X_LABEL = "data of the changed robot [s]"
Y_LABEL = "RMSE [N m]"
COLUMNS = 4
PANEL_INCH = 2.0
APART = 0.02  # between two marks at one place [decades]


def fine_tuning(
    settings: FineTuning, seconds: Sequence[int], statistics: Statistics, scores: Sequence[Path], figure_dir: Path
) -> None:
    """Write the figure as PDF, PNG and CSV: RMSE [N m] of networks on changed robots over their new data [s].

    Two bands stand beside them: the networks before, and on the robot that they learned from.
    """
    read = read_scores(*scores)
    panels = []
    rows = []
    for title, test in settings.tests.items():
        found = []
        for label, shown in shown_of(settings, seconds, test).items():
            errors = [number_of(read, [wanted], statistics) for wanted in shown]
            found.append((label, dict(zip(seconds, errors, strict=True))))
            for time, wanted, error in zip(seconds, shown, errors, strict=True):
                place = (title, label, time, wanted.scenario, wanted.level, wanted.method, wanted.joint)
                rows.append((*place, *error.with_ends, *error.spread, error.unit))
        panels.append(panel_of(title, found))
    figure = draw_lines(panels, min(COLUMNS, len(panels)), PANEL_INCH)
    save_figure(figure, figure_dir / "fine_tuning", TUNED, rows)


def panel_of(title: str, found: Sequence[tuple[str, Mapping[int, Number]]]) -> LinePanel:
    """Return the panel of a test: of each label the error by seconds; those that need none of these are bands."""
    bands: dict[str, Number] = {}
    lines: list[Line] = []
    for label, errors in found:
        if label in (BEFORE, KNOWN):
            bands[label] = next(iter(errors.values()))
        else:
            lines.append(Line(label, list(errors), list(errors.values())))
    return LinePanel(title, X_LABEL, Y_LABEL, lines, bands, dodge=APART)


def shown_of(settings: FineTuning, seconds: Sequence[int], test: TunedTest) -> dict[str, list[Wanted]]:
    """Return line -> what is looked at for each number of seconds (n,)."""
    (before,) = test.methods

    def wanted(level: str, method: str) -> Wanted:
        return Wanted(test.scenario, settings.limb, level, method, settings.joint)

    shown = {BEFORE: [wanted(test.level, before)] * len(seconds)}
    for label, base in test.tuned.items():
        shown[label] = [wanted(test.level, swept_name(base, settings.sweep, time)) for time in seconds]
    shown[KNOWN] = [wanted(test.known, before)] * len(seconds)
    return shown
