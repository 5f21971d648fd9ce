"""Every metric is declared once, with its unit and its range."""

import csv
import re
from pathlib import Path

import pytest

from experiments.settings.evaluation import Evaluation
from experiments.settings.metrics import METRIC, METRICS, SECTIONS, metric_of, unit_of_metric
from mobnet.core.errors import ConfigError

GOLDEN = Path(__file__).parents[2] / "golden"
MADE = ("factor", "gone", "share", "skill")  # by tables, of metrics
RATIO = " over that of "  # between a metric and a method, by figures


def golden_metrics() -> set[tuple[str, str]]:
    """Return metric and unit of the rows of the golden tables that name both."""
    tables = (csv.DictReader(path.read_text().splitlines()) for path in GOLDEN.glob("*.csv"))
    rows = [row for table in tables for row in table if {"metric", "unit"} <= row.keys()]
    return {
        (name, row["unit"])
        for row in rows
        for name in row["metric"].split("+")
        if name not in MADE and RATIO not in name
    }


def test_the_metrics_of_the_golden_tables_have_their_units() -> None:
    found = golden_metrics()
    assert {"rmse", "r_rmse", "known_share", "rise_delay"} <= {metric for metric, _ in found}
    assert all(unit in {unit_of_metric(metric, joint) for joint in ("N", "N m")} for metric, unit in found)


@pytest.mark.parametrize(
    ("name", "unit"),
    [("rmse_push_2_raw", "N m"), ("roughness", "N m/s"), ("gain_0.5hz", "-"), ("phase_2hz", "deg"),
     ("held_swing_3", "-"), ("std_part_4", "N m"), ("cover_stance", "-"), ("acf_10ms", "-"),
     ("excursion", "ms"), ("free_share", "-")],
)  # fmt: skip
def test_a_metric_is_declared_once_and_has_one_unit(name: str, unit: str) -> None:
    assert sum(re.fullmatch(kind.names, name) is not None for kind in METRICS) == 1
    assert re.fullmatch(METRIC, name)
    assert unit_of_metric(name, "N m") == unit
    assert unit in metric_of(name).units


@pytest.mark.parametrize("name", ["rmse_push_0", "share", "acf_ms", "rmse_part_", ""])
def test_another_name_is_refused(name: str) -> None:
    with pytest.raises(ConfigError, match=f"metric: {name!r} is not accepted; accepted: "):
        metric_of(name)


def test_what_asks_for_metrics_is_a_section_of_the_evaluation() -> None:
    assert set(SECTIONS) <= Evaluation.model_fields.keys()
