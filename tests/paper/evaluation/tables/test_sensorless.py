"""The table of walks that nothing stands in the way of: events in an hour, and the error of the base's velocity."""

from dataclasses import replace

import pytest
from csv_files import check_golden
from made_trials import FREE, write_trials
from paper_settings import settings_at

from experiments.evaluation.measure.reaction.results import POWER, TRACKING, VELOCITY
from experiments.evaluation.tables.further.sensorless import sensorless
from experiments.records.reactions import NONE
from mobnet.core.rows import read_texts

SETTINGS = settings_at()
ROWS = [
    FREE,
    replace(FREE, seed=241, walked_s=30.0, alarm_s=30.0, reacted_s=30.0, limb="RA", velocity_rmse_m_s=0.005),
    replace(FREE, seed=242, walked_s=90.0, fell_s=90.0, level="robot_2"),
    replace(FREE, detector=NONE, rule="", wrench="sensed", velocity_rmse_m_s=0.002),
    replace(FREE, detector=NONE, rule="", wrench="sensed", feed_forward=0.5, tracking_rmse_rad=0.008, power_w=210.0),
    replace(FREE, case="free_all", walked_s=20.0, alarm_s=20.0, reacted_s=20.0, limb="V"),
]


@pytest.fixture
def cells(tmp_path):
    """The rows of the table of ROWS by wrench, fed share and event; of walks with all limbs by case, too."""
    reactions = write_trials(tmp_path, ROWS)
    reactions["robot_1"]["foot"] = tmp_path / "not_asked_for.csv"
    sensorless(SETTINGS.evaluation.sensorless, SETTINGS.evaluation.statistics, reactions, tmp_path)
    found = {}
    for row in read_texts(tmp_path / "sensorless.csv"):
        own = () if row["case"] == "free" else (row["case"],)
        found[*own, row["wrench"], row["feed_forward"], row["event"]] = row
    return found


def test_events_are_counted_over_the_time_that_robots_walk_as_told(cells):
    falls, reactions = cells["estimated", "0", "falls"], cells["estimated", "0", "false reactions"]
    assert (falls["events"], reactions["events"], falls["walks"]) == ("1", "1", "3")
    assert float(falls["hours"]) == pytest.approx(0.05)
    assert float(falls["value"]) == pytest.approx(20.0)
    assert float(falls["low"]) < 0.0253 / 0.05  # of one event in independent walks, Garwood 1936; here of two robots
    assert float(falls["high"]) > 5.572 / 0.05


def test_walks_with_all_limbs_are_counted_by_themselves(cells):
    row = cells["free_all", "estimated", "0", "false reactions"]
    assert (row["events"], row["walks"]) == ("1", "1")
    assert float(row["hours"]) == pytest.approx(20.0 / 3600.0, rel=1e-5)


def test_the_table_is_the_golden_one(cells, tmp_path):
    check_golden(tmp_path / "sensorless.csv")


def test_a_single_walk_has_no_interval(cells):
    falls = cells["sensed", "0", "falls"]
    assert (falls["events"], falls["value"], falls["low"], falls["high"]) == ("0", "0", "", "")


def test_the_velocity_s_error_is_the_mean_of_the_walks(cells, tmp_path):
    assert float(cells["estimated", "0", VELOCITY]["value"]) == pytest.approx(11.0 / 3.0, rel=1e-5)
    assert float(cells["sensed", "0", VELOCITY]["value"]) == 2.0
    lines = [line for line in (tmp_path / "sensorless.md").read_text().splitlines() if line.startswith("| ")]
    assert "3.0" in lines[2]  # minutes
    assert "sensed" in lines[3]


def test_what_feed_forward_changes_stands_in_a_line_of_its_own(cells):
    fed, unfed = ([cells["sensed", share, event]["value"] for event in (TRACKING, POWER)] for share in ("0.5", "0"))
    assert (fed, unfed) == (["8", "210"], ["10", "200"])
