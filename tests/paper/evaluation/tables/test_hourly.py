"""Falls and false flags in an hour: sums over recordings and runs, with the interval of their count."""

from collections.abc import Callable
from pathlib import Path

import pytest
from csv_files import check_golden, read_table
from paper_settings import STATISTICS

from experiments.evaluation.tables.further.hourly import ALL, FALL, FLAG
from experiments.intervals.single import rate_of
from experiments.settings.evaluation import Evaluation
from experiments.settings.runs import LegRuns
from experiments.settings.tables import Hourly
from mobnet.core.files import write_json

COUNTS = {"rmse": (2.0, "N m"), "flags": (1.0, "-"), "watched": (0.5, "h")}


def walked(path: Path, hours: float, falls: int) -> Path:
    """Write the note of a recording; return its place without its ending."""
    rows, column = round(hours * 3.6e6), {"name": "pushed", "unit": "-", "frame": "scenario"}
    note = {"rows": rows, "rate_hz": 1000.0, "segments": [[0, rows]], "columns": [column], "falls": falls}
    write_json(path.with_suffix(".json"), note)
    return path


def test_events_of_all_walks_are_counted_together(
    make_table: Callable[..., Path], evaluation: Evaluation, write_measured: Callable[..., list[Path]], tmp_path: Path
) -> None:
    tests = {
        title: LegRuns(scenario="changed_walk", level=level, methods=("MOB-Net",), limbs=("LL",))
        for title, level in (("as known", "robots"), ("in place", "robots_warm"), ("changed", "robots_law"))
    }
    scores = write_measured(tests.values(), COUNTS)
    plant = [walked(tmp_path / "a", 0.5, 2), walked(tmp_path / "b", 1.5, 1)]
    walks = {"plant": plant, "robots": [walked(tmp_path / "c", 3.0, 0)]}
    table = make_table(
        "hourly", settings=Hourly(known=("as known", "in place")), walks=walks, scores=scores,
        changed=evaluation.changed.model_copy(update={"tests": tests}),
    )  # fmt: skip
    rows = {(row.event, row.walks): row for row in read_table(table)}
    assert (rows[FALL, "plant"].hours, rows[FALL, "plant"].count, rows[FALL, "plant"].value) == (2.0, 3, 1.5)
    assert (rows[FALL, "robots"].count, rows[FALL, "robots"].low) == (0, 0.0)
    assert rows[FALL, "robots"].high == pytest.approx(3.689 / 3.0, abs=0.001)
    single, both = rows[FLAG, "as known"], rows[FLAG, ALL]
    assert (FLAG, "changed") not in rows
    assert both.count == single.count + rows[FLAG, "in place"].count
    assert both.value == pytest.approx(both.count / both.hours, rel=1e-4)
    check_golden(table)


@pytest.mark.parametrize(("count", "ends"), [(0, (0.0, 3.689)), (1, (0.0253, 5.572)), (10, (4.795, 18.39))])
def test_a_count_has_the_interval_that_tables_print(count: int, ends: tuple[float, float]) -> None:
    """Exact limits of a Poisson count (Garwood 1936, Table 1)."""
    found = rate_of(count, 2.0, STATISTICS)
    assert found.value == count / 2.0
    assert found.with_ends[1:] == pytest.approx([end / 2.0 for end in ends], rel=1e-3)
