"""Table of all methods, test by test: errors against both truths, and what is gained over estimating nothing."""

from collections.abc import Sequence
from pathlib import Path

import pandas as pd

from experiments.evaluation.compare.rmse import RAW
from experiments.evaluation.number.frames import read_scores, records_of
from experiments.evaluation.number.laws import measured
from experiments.evaluation.number.number import Number, interval_text, number_text
from experiments.evaluation.number.scored import AVERAGE, number_of, runs_of
from experiments.evaluation.tables.layout import Line, Table, in_blocks, long_table, write_table
from experiments.intervals.crossed import MEAN
from experiments.intervals.quantities import CUT
from experiments.settings.runs import Statistics
from experiments.settings.table_columns import METHODS
from experiments.settings.tables import MethodsRow

ZERO, SKILL = "zero", "skill"  # the method that estimates nothing, and 1 - RMSE / RMSE of it
LABELS = {"": "RMSE", RAW: "raw truth", SKILL: SKILL}  # what is shown -> what the text calls it
CAPTION = r"\methodscaption"  # the paper's
PLACE = ["row", "place"]  # of a number


def methods(settings: Sequence[MethodsRow], statistics: Statistics, scores: Sequence[Path], table_dir: Path) -> None:
    """Write methods.csv, .tex and .md: RMSE [N m] of every method, and skill, a column a joint or a limb's average.

    The error is against the low-passed truth, as the paper's, and against the raw one. The skill is 1 - RMSE / rms of
    the low-passed truth, whose root mean square is the RMSE of estimating nothing.
    """
    asked = asked_of(settings)

    def law(runs: pd.DataFrame) -> Number:
        return number_of(runs, statistics, CUT if runs["what"].iloc[0] == SKILL else MEAN)

    numbers = measured(runs_of(read_scores(*scores), asked, may_lack=True), PLACE, {"number": law})
    # Of a skill both errors are asked for, the method's first.
    rows = asked.drop_duplicates(PLACE).merge(numbers, on=PLACE)
    rows.loc[rows["what"] == SKILL, ["metric", "unit"]] = SKILL, "-"
    places = rows[["limb", "joint"]].drop_duplicates()
    heads = [f"{limb} {joint}" if joint == AVERAGE else joint for limb, joint in places.itertuples(index=False)]
    header = ["Test", "Method", "", *heads]
    lines = method_lines(rows, pd.MultiIndex.from_frame(places), statistics.confidence)
    tex = long_table("lll" + "r" * len(places), CAPTION, header, lines)
    records = records_of(rows[rows["value"].notna()], METHODS)
    write_table(table_dir / "methods", Table(METHODS, records, header, lines, left=3), tex)


def asked_of(settings: Sequence[MethodsRow]) -> pd.DataFrame:
    """Return what is asked for: `row` by `row` of the table, a test, a method and what is shown of it; by `place`.

    That is errors, and skill where estimating nothing is one of the test's methods.
    """
    asked: list[dict[str, object]] = []
    row = 0
    for test in settings:
        for method in test.methods:
            has_skill = ZERO in test.methods and method != ZERO
            for what in ("", RAW, SKILL) if has_skill else ("", RAW):
                row += 1
                for place, (limb, joint) in enumerate(places_of(test)):
                    metric = test.metric + (RAW if what == RAW else "")
                    of = {"row": row, "place": place, "what": what, "limb": limb, "joint": joint, "metric": metric}
                    for name in (method, ZERO) if what == SKILL else (method,):
                        asked.append({**of, "scenario": test.scenario, "level": test.level, "method": name})
    return pd.DataFrame(asked)


def places_of(test: MethodsRow) -> list[tuple[str, str]]:
    """Return the limbs and joints that a test asks for, limb by limb."""
    places: list[tuple[str, str]] = []
    for limb, joints in test.columns.items():
        places += [(limb, joint) for joint in joints]
    return places


def method_lines(rows: pd.DataFrame, places: pd.MultiIndex, confidence: float) -> list[Line]:
    """Return the rows of text, test by test: errors [N m] with intervals, errors against the raw truth, and skill.

    A test that does not ask for a place, a limb and a joint, has a dash there.
    """
    blocks: dict[tuple[str, str], list[list[str]]] = {}
    for _, of_row in rows.groupby("row"):
        scenario, level, method, what = of_row[["scenario", "level", "method", "what"]].iloc[0]
        lines = blocks.setdefault((f"{scenario}, {level}".replace("_", " "), method), [])
        numbers = of_row.set_index(["limb", "joint"]).reindex(places)
        lines.append([LABELS[what], *map(number_text, numbers["value"])])
        if not what and of_row["low"].notna().any():
            lines.append([f"{confidence:.0%}", *map(interval_text, numbers["low"], numbers["high"])])
    return in_blocks(blocks.items(), nested=True)
