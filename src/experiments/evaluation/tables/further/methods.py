"""Table of all methods, test by test: errors against both truths, and what is gained over estimating nothing."""

from collections.abc import Mapping, Sequence
from dataclasses import replace
from pathlib import Path

from experiments.evaluation.compare.rmse import RAW
from experiments.evaluation.number.grid import AVERAGE, Lookup, Wanted, read_lookup
from experiments.evaluation.number.number import Number
from experiments.evaluation.number.quantities import CUT
from experiments.evaluation.number.rows import Field
from experiments.evaluation.tables.layout import Line, Table, in_blocks, long_table, write_table
from experiments.settings.runs import Statistics
from experiments.settings.tables import MethodsRow
from mobnet.core.columns import METHODS

ZERO, SKILL = "zero", "skill"  # the method that estimates nothing, and 1 - RMSE / RMSE of it
CAPTION = r"\methodscaption"  # the paper's
Place = tuple[str, str]  # limb and joint, or its average
Row = tuple[int, str, str]  # number of the test, method, metric or SKILL


def methods(settings: Sequence[MethodsRow], statistics: Statistics, scores: Sequence[Path], table_dir: Path) -> None:
    """Write methods.csv, .tex and .md: RMSE [N m] of every method, and skill, a column a joint or a limb's average.

    The error is against the low-passed truth, as the paper's, and against the raw one. The skill is 1 - RMSE / rms of
    the low-passed truth, whose root mean square is the RMSE of estimating nothing.
    """
    lookup = read_lookup(scores, statistics)
    rows: dict[Row, dict[Place, Number]] = {}
    known: dict[Place, None] = {}
    for k, test in enumerate(settings):
        asked = places_of(test)
        known |= dict.fromkeys(asked)
        for method in test.methods:
            for metric in metrics_of(test, method):
                numbers = {place: number_of(lookup, test, method, metric, place) for place in asked}
                rows[k, method, metric] = numbers
    places = list(known)
    records: list[tuple[Field, ...]] = []
    for (k, method, metric), own in rows.items():
        test = settings[k]
        for place, ours in own.items():
            if ours.value is not None:
                numbers = *ours.with_ends, *ours.spread
                records.append((test.scenario, test.level, method, *place, metric, *numbers, ours.unit))
    header = ["Test", "Method", "", *(f"{limb} {joint}" if joint == AVERAGE else joint for limb, joint in places)]
    lines = method_lines(settings, rows, places, statistics.confidence)
    tex = long_table("lll" + "r" * len(places), CAPTION, header, lines)
    write_table(table_dir / "methods", Table(METHODS, records, header, lines, left=3), tex)


def places_of(test: MethodsRow) -> list[Place]:
    """Return the limbs and joints that a test asks for, limb by limb."""
    places: list[Place] = []
    for limb, joints in test.columns.items():
        places += [(limb, joint) for joint in joints]
    return places


def metrics_of(test: MethodsRow, method: str) -> list[str]:
    """Return what is shown of a method in a test: errors, and skill where estimating nothing is one of its methods."""
    return [test.metric, test.metric + RAW, *([SKILL] if ZERO in test.methods and method != ZERO else [])]


def number_of(lookup: Lookup, test: MethodsRow, method: str, metric: str, place: Place) -> Number:
    """Return an error [N m] or the skill [-] of a method at a place, with its interval; none where it has none."""
    limb, joint = place
    if metric != SKILL:
        return lookup.number([Wanted(test.scenario, limb, test.level, method, joint, metric)])
    pair = [Wanted(test.scenario, limb, test.level, name, joint, test.metric) for name in (method, ZERO)]
    if not lookup.number(pair[1:]).value:
        return Number(None)
    return replace(lookup.number(pair, CUT), unit="-")


def method_lines(
    settings: Sequence[MethodsRow],
    rows: Mapping[Row, Mapping[Place, Number]],
    places: Sequence[Place],
    confidence: float,
) -> list[Line]:
    """Return the rows of text, test by test: errors [N m] with intervals, errors against the raw truth, and skill.

    A test that does not ask for a place, a limb and a joint, has a dash there.
    """
    blocks: dict[tuple[str, str], list[list[str]]] = {}
    for (k, method, metric), own in rows.items():
        test = settings[k]
        name = f"{test.scenario}, {test.level}".replace("_", " ")
        numbers = [own.get(place, Number(None)) for place in places]
        lines = blocks.setdefault((name, method), [])
        label = "RMSE" if metric == test.metric else "raw truth" if metric.endswith(RAW) else SKILL
        lines.append([label, *(number.text() for number in numbers)])
        if metric == test.metric and any(number.low is not None for number in numbers):
            lines.append([f"{confidence:.0%}", *(number.interval() for number in numbers)])
    return in_blocks(blocks.items(), nested=True)
