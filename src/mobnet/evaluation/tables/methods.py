"""Table of all methods, test by test: errors of the left leg in walking, of waist and arm in motion."""

from collections.abc import Mapping, Sequence
from pathlib import Path

from mobnet.core.columns import METHODS
from mobnet.evaluation.measure.scores import AVERAGE
from mobnet.evaluation.number.grid import Wanted, number_of
from mobnet.evaluation.number.number import Number
from mobnet.evaluation.number.rows import read_scores
from mobnet.evaluation.tables.layout import Line, Table, in_blocks, with_intervals, write_table
from mobnet.settings.evaluation import MethodsRow, Statistics


def methods(
    settings: Sequence[MethodsRow], statistics: Statistics, scores: Mapping[str, Path], table_dir: Path
) -> None:
    """Write methods.csv, .tex and .md: RMSE [N m] of every method, a column a joint or a limb's average."""
    errors: dict[Wanted, Number] = {}
    for test in settings:
        rows = read_scores(scores[test.scenario])
        for method in test.methods:
            places = [(limb, joint) for limb, joints in test.columns.items() for joint in joints]
            for wanted in (Wanted(test.scenario, limb, test.level, method, joint) for limb, joint in places):
                errors[wanted] = number_of(rows, [wanted], statistics)
    records = [
        (of.scenario, of.level, of.method, of.limb, of.joint, of.metric, *ours.with_ends, *ours.spread, ours.unit)
        for of, ours in errors.items()
    ]
    places = list(dict.fromkeys((of.limb, of.joint) for of in errors))
    header = ["Test", "Method", *(f"{limb} {joint}" if joint == AVERAGE else joint for limb, joint in places)]
    lines = method_lines(errors, places, statistics.confidence)
    write_table(table_dir / "methods", Table(METHODS, records, header, lines, left=2))


def method_lines(errors: Mapping[Wanted, Number], places: list[tuple[str, str]], confidence: float) -> list[Line]:
    """Return the rows of text, test by test, a method's errors [N m] above their intervals.

    A test that does not ask for a place, a limb and a joint, has a dash there.
    """
    rows: dict[tuple[str, str], dict[tuple[str, str], Number]] = {}
    for of, ours in errors.items():
        test = f"{of.scenario}, {of.level}".replace("_", " ")
        rows.setdefault((test, of.method), {})[of.limb, of.joint] = ours
    cells = {key: [own.get(place, Number(None)) for place in places] for key, own in rows.items()}
    blocks = [([test], with_intervals([method], own, confidence)) for (test, method), own in cells.items()]
    return in_blocks(blocks, nested=True)
