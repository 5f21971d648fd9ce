"""Table of all methods, test by test: errors of the left leg in walking, of waist and arm in motion."""

from collections.abc import Mapping, Sequence
from pathlib import Path

from mobnet.core.columns import METHODS, Score
from mobnet.evaluation.measure.scores import AVERAGE
from mobnet.evaluation.number.files import read_rows
from mobnet.evaluation.number.grid import Wanted, number_of
from mobnet.evaluation.number.number import Number
from mobnet.evaluation.tables.layout import Line, Table, in_blocks, with_intervals, write_table
from mobnet.settings.evaluation import MethodsRow, Statistics

Errors = Mapping[Wanted, Number]


def methods(
    settings: Sequence[MethodsRow], statistics: Statistics, seed: int, scores: Mapping[str, Path], table_dir: Path
) -> None:
    """Write methods.csv, .tex and .md: RMSE [N m] of every method, a column a joint or a limb's average.

    Args:
        settings: tests with their columns and methods.
        statistics: what intervals need.
        seed: of the intervals.
        scores: scenario -> its scores.
        table_dir: gets the three files.

    Raises:
        DataError: a run that the table needs is missing.
    """
    errors: dict[Wanted, Number] = {}
    for test in settings:
        rows = read_rows(scores[test.scenario], Score)
        for method in test.methods:
            for limb, joint in ((limb, joint) for limb, joints in test.columns.items() for joint in joints):
                wanted = Wanted(test.scenario, limb, test.level, method, joint)
                errors[wanted] = number_of(rows, [wanted], statistics, seed)
    records = [
        (of.scenario, of.level, of.method, of.limb, of.joint, of.metric, ours.runs, *ours.with_ends, ours.unit)
        for of, ours in errors.items()
    ]
    places = list(dict.fromkeys((of.limb, of.joint) for of in errors))
    header = ["Test", "Method", *(f"{limb} {joint}" if joint == AVERAGE else joint for limb, joint in places)]
    lines = method_lines(errors, places, statistics.confidence)
    write_table(table_dir / "methods", Table(METHODS, records, header, lines, left=2))


def method_lines(errors: Errors, places: list[tuple[str, str]], confidence: float) -> list[Line]:
    """Return the rows of text, test by test, a method's errors [N m] above their intervals.

    Args:
        errors: of all tests.
        places: limb and joint of each column; a test that does not ask for one gets dashes there.
        confidence: of the intervals, a share [-].
    """
    rows: dict[tuple[str, str], dict[tuple[str, str], Number]] = {}
    for of, ours in errors.items():
        test = f"{of.scenario}, {of.level}".replace("_", " ")
        rows.setdefault((test, of.method), {})[of.limb, of.joint] = ours
    return in_blocks(
        (
            ([test], with_intervals([method], [own.get(place, Number(None)) for place in places], confidence))
            for (test, method), own in rows.items()
        ),
        nested=True,
    )
