"""Falls by random torque: the largest one up to which a robot does not fall is its own, whatever comes after it."""

from collections.abc import Sequence
from dataclasses import astuple
from pathlib import Path

import pytest
from csv_files import check_golden_table
from paper_settings import STATISTICS

from experiments.evaluation.measure.data.random_torque import count_falls
from experiments.evaluation.number.rows import write_csv
from experiments.evaluation.tables.further.falls import ALL, falls
from experiments.plan.jobs import walk_settings
from experiments.records.falls import FALLS, Falls
from experiments.settings.settings import Settings
from mobnet.core.rows import read_rows, read_texts


@pytest.mark.parametrize(("counts", "chosen"), [
    (([0, 0, 0], [0, 0, 2]), (150, 100, 100)),
    (([0, 0, 0], [0, 1, 0]), (150, 50, 50)),  # what is too large stays so where a larger one happens not to be
    (([0, 0, 0], [0, 0, 0], [1, 0, 0]), (150, 150, 0, 150)),
    (([1, 0, 0], [0, 0, 1], [0, 1, 1]), (0, 100, 50, 50)),
])  # fmt: skip
def test_the_torque_is_raised_until_a_robot_falls_and_the_median_robot_chooses(
    tmp_path: Path, counts: Sequence[Sequence[int]], chosen: Sequence[int]
) -> None:
    paths = [tmp_path / f"robot_{k}.csv" for k, _ in enumerate(counts, start=1)]
    for path, own in zip(paths, counts, strict=True):
        rows = [Falls(path.stem, 50.0 * k, 900.0, fallen) for k, fallen in enumerate(own, start=1)]
        write_csv(path, FALLS, [astuple(row) for row in rows])
    falls(paths, STATISTICS, tmp_path / "out")
    rows = read_texts(tmp_path / "out.csv")
    robots = dict.fromkeys(row["robot"] for row in rows)
    marked = {row["robot"]: int(row["amplitude_nm"]) for row in rows if row["chosen"] == "1"}
    assert [marked.get(robot, 0) for robot in robots] == list(chosen)
    together = [row for row in rows if row["robot"] == ALL]
    assert [int(row["falls"]) for row in together] == [sum(own) for own in zip(*counts, strict=True)]
    assert [float(row["per_hour"]) for row in together] == pytest.approx(
        [int(row["falls"]) / (len(counts) * 0.25) for row in together], abs=1e-5
    )
    lines = (tmp_path / "out.md").read_text().splitlines()
    assert lines[-1].split(" | ")[1 : len(chosen) + 1] == list(map(str, chosen))


def test_the_table_is_the_golden_one(tmp_path: Path) -> None:
    """Three robots, of which one falls at once and one walked longer."""
    walked_s = {"robot_1": 900.0, "robot_2": 1200.0, "robot_3": 900.0}
    counts = {"robot_1": (0, 0, 3), "robot_2": (0, 1, 0), "robot_3": (1, 0, 0)}
    for robot, fallen in counts.items():
        rows = [(robot, 12.5 * k, walked_s[robot], count) for k, count in enumerate(fallen, start=1)]
        write_csv(tmp_path / f"{robot}.csv", FALLS, rows)
    falls([tmp_path / f"{robot}.csv" for robot in counts], STATISTICS, tmp_path / "falls")
    check_golden_table(tmp_path / "falls.csv")


def test_nothing_is_promised_about_an_hour_in_which_nothing_fell(tmp_path: Path) -> None:
    """By Poisson's law, no fall in half an hour allows 7.4 an hour."""
    write_csv(tmp_path / "r.csv", FALLS, [("robot_1", 50.0, 1800.0, 0)])
    falls([tmp_path / "r.csv"], STATISTICS, tmp_path / "out")
    assert float(read_texts(tmp_path / "out.csv")[-1]["high"]) == pytest.approx(7.38, abs=0.01)


@pytest.mark.slow
@pytest.mark.sim
def test_a_robot_that_cannot_stand_a_torque_falls(tmp_path: Path, settings: Settings) -> None:
    walk = walk_settings(settings, "robot_walk", "robot_1")
    count_falls(walk, 701, (1.0, 900.0), 6.0, tmp_path / "falls.csv")
    calm, wild = read_rows(tmp_path / "falls.csv", Falls)
    assert (calm.robot, calm.amplitude_nm, calm.walked_s, calm.falls) == ("robot_1", 1.0, 6.0, 0)
    assert wild.falls > 0
