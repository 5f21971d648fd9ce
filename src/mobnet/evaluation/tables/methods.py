"""Table of all methods, test by test: errors of the left leg in walking, of waist and arm in motion."""

from __future__ import annotations

import logging
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from mobnet.core.files import write_text
from mobnet.evaluation.measure.scores import AVERAGE
from mobnet.evaluation.number.grid import Wanted, run_grid, unit_of
from mobnet.evaluation.number.intervals import summarise
from mobnet.evaluation.number.rows import Score, read_rows, write_rows
from mobnet.evaluation.tables.layout import GAP, RULE, Line, markdown_table, number, span, text_table

log = logging.getLogger(__name__)

LEFT = 2  # columns of text


@dataclass(frozen=True)
class Error:
    """One error of a method: a row of methods.csv.

    Attributes:
        scenario: the test.
        level: uncertainty level.
        method: estimator.
        limb: limb of section 4.1.
        joint: joint of the limb, or `avg`.
        metric: a name of `metrics.METRICS`.
        runs: network seeds times test seeds.
        value: mean over runs [unit].
        low: lower end of its interval [unit]; None with a single run.
        high: upper end of its interval [unit]; None with a single run.
        unit: unit of the numbers.
    """

    scenario: str
    level: str
    method: str
    limb: str
    joint: str
    metric: str
    runs: int
    value: float
    low: float | None
    high: float | None
    unit: str


def methods(config: Mapping[str, Any], scores: Mapping[str, Path], out_dir: Path) -> None:
    """Write methods.csv, .tex and .md: RMSE [N m] of every method, a column a joint or a limb's average.

    Args:
        config: resolved configuration: `seed`, `evaluation.methods` (tests, each with scenario, level, columns: limb ->
            joints, and methods) and what intervals need.
        scores: scenario -> its scores.
        out_dir: gets the three files.

    Raises:
        DataError: a run that the table needs is missing.
    """
    tests, confidence = config["evaluation"]["methods"], config["evaluation"]["confidence"]
    errors = [error for test in tests for error in errors_of(config, test, read_rows(scores[test["scenario"]], Score))]
    header, lines = overview_lines(errors, confidence)
    write_rows(out_dir / "methods.csv", Error, errors)
    write_text(out_dir / "methods.tex", text_table("ll" + "r" * (len(header) - LEFT), header, lines))
    write_text(out_dir / "methods.md", markdown_table(header, lines, left=LEFT))
    log.info("%s: %d errors", out_dir / "methods.csv", len(errors))


def errors_of(config: Mapping[str, Any], test: Mapping[str, Any], scores: Sequence[Score]) -> Iterator[Error]:
    """Yield the errors [N m] that a test asks for, method by method.

    Raises:
        DataError: a run is missing.
    """
    for method in test["methods"]:
        for limb, joints in test["columns"].items():
            for joint in joints:
                wanted = Wanted(test["scenario"], limb, test["level"], method, joint)
                ours = summarise([run_grid(scores, wanted)], config)
                yield Error(
                    wanted.scenario, wanted.level, method, limb, joint, wanted.metric, ours.count,
                    ours.value, ours.low, ours.high, unit_of(scores, wanted),
                )  # fmt: skip


def overview_lines(errors: Sequence[Error], confidence: float) -> tuple[list[str], list[Line]]:
    """Return the header and the rows of text, test by test, a method's errors [N m] above their intervals.

    Args:
        errors: of all tests; a test that does not ask for a column gets dashes there.
        confidence: of the intervals, a share [-].
    """
    places = list(dict.fromkeys((error.limb, error.joint) for error in errors))
    header = ["Test", "Method", *(f"{limb} {joint}" if joint == AVERAGE else joint for limb, joint in places)]
    lines: list[Line] = []
    before = ""
    for test, method in dict.fromkeys((name_of_test(error), error.method) for error in errors):
        own = {(e.limb, e.joint): e for e in errors if (name_of_test(e), e.method) == (test, method)}
        found = [own.get(place) for place in places]
        if lines:
            lines.append(GAP if test == before else RULE)
        lines.append(["" if test == before else test, method, *(number(error and error.value) for error in found)])
        if any(error and error.low is not None for error in found):
            lines.append(["", f"{confidence:.0%}", *(span(error.low, error.high) if error else "" for error in found)])
        before = test
    return header, lines


def name_of_test(error: Error) -> str:
    """Return a test's name as text, such as `walk test, all uncertainty`."""
    return f"{error.scenario}, {error.level}".replace("_", " ")
