"""The overview holds every method once, with dashes where a test leaves it out."""

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from mobnet.evaluation.overview import Error, methods
from mobnet.evaluation.rows import read_rows

MEANS = {"MOB": 9.0, "MOB-Net": 2.0, "FTS-e2e": 3.0}


@pytest.fixture
def table(tmp_path: Path, config: dict[str, Any], write_limb_scores: Callable[..., Path]) -> Path:
    """The overview of made-up scores."""
    scores = {name: write_limb_scores(name, MEANS) for name in ("walk_test", "motion_test")}
    methods(config, scores, tmp_path)
    return tmp_path / "methods.csv"


def test_errors_are_those_asked_for_test_by_test(table: Path) -> None:
    errors = read_rows(table, Error)
    assert [(error.method, error.limb, error.joint) for error in errors] == [
        *((method, "LL", joint) for method in MEANS for joint in ("LL3", "avg")),
        *((method, limb, "avg") for method in ("MOB", "MOB-Net") for limb in ("W", "RA")),
    ]
    for error in errors:
        assert error.value == pytest.approx(MEANS[error.method])
        assert error.runs == (2 if error.method == "MOB" else 4)
        assert error.unit == "N m"


def test_a_method_has_one_row_and_dashes_where_it_is_not_tested(table: Path) -> None:
    lines = table.with_suffix(".md").read_text().splitlines()
    assert lines[0] == "| Method | LL3 | LL avg | W avg | RA avg |"
    assert [line.split("|")[1].strip() for line in lines[2:]] == ["MOB", "95%", "MOB-Net", "95%", "FTS-e2e", "95%"]
    assert lines[6] == "| FTS-e2e | 3.00 | 3.00 | - | - |"
    assert lines[7].endswith("|  |  |")
