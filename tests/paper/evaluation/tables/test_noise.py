"""The table of noise: errors beside the paper's, and a factor that sees joints that are too quiet or too loud alike."""

import itertools
import math
from collections.abc import Callable
from pathlib import Path

import pytest
from csv_files import check_golden, read_table, write_rows

from experiments.evaluation.number.number import published_row
from experiments.evaluation.tables.further.noise import ALL, FACTOR
from experiments.records.scores import Score
from experiments.settings.settings import Settings
from mobnet.core.joints import JointLayout

TIMES = {"sensor_noise": (2.0, 0.5), "swapped_noise": (1.0, 1.0), "printed_noise": (20.0, 10.0)}  # legs, all others


@pytest.fixture
def table(tmp_path: Path, settings: Settings, layout: JointLayout, make_table: Callable[..., Path]) -> Path:
    """The table of errors that are the paper's, times factors by level and limb."""
    section, printed, rows = settings.evaluation.noise, settings.published.tables, []
    paper = {name: value for key, place in section.paper.items()
             for name, value in published_row(printed[key], place, "MOB").items()}  # fmt: skip
    for (level, times), test in itertools.product(TIMES.items(), (1, 2)):
        for limb, joint in ((name, joint) for name in section.joints for joint in layout.limb(name)):
            value = (paper[joint] or 0.0) * times[limb != "LL"] * (1 + 0.1 * (test - 1.5))
            run = ("forward_walk", level, "MOB", 0, test, limb, joint)
            rows.append(Score(*run, "rmse", value, layout.unit(joint)))
    write_rows(tmp_path / "forward_walk.csv", rows)
    tables = {name: printed[name] for name in section.paper}
    return make_table("noise", scores=[tmp_path / "forward_walk.csv"], printed=tables)


def test_a_reading_that_is_too_quiet_is_as_far_off_as_one_that_is_too_loud(table: Path) -> None:
    check_golden(table)
    found = {(row.level, row.joint): row.value for row in read_table(table) if row.metric == FACTOR}
    assert found["sensor_noise", "LL"] == pytest.approx(2.0)
    assert found["sensor_noise", "W"] == found["sensor_noise", "V"] == pytest.approx(2.0)
    assert found["sensor_noise", ALL] == pytest.approx(2.0)
    assert found["swapped_noise", ALL] == pytest.approx(1.0)
    joints = {"LL": 6, "W": 3, "LA": 8, "V": 6}
    others = sum(count for limb, count in joints.items() if limb != "LL")
    mean = (6 * math.log(20.0) + others * math.log(10.0)) / (6 + others)
    assert found["printed_noise", ALL] == pytest.approx(math.exp(mean))


def test_readers_see_the_paper_s_row_and_every_reading_joint_by_joint(table: Path) -> None:
    header, _, *lines = table.with_suffix(".md").read_text().splitlines()
    assert header == "| Joint | Unit | Original | standard deviations | two rows exchanged | variances |"
    assert lines[0] == "| LL1 | N m | 0.44 | 0.88 | 0.44 | 8.80 |"
    assert "| V1 | N | 3.98 | 1.99 | 3.98 | 39.80 |" in lines
    assert [line.split("|")[1].strip() for line in lines[-5:]] == [
        f"factor, {name}" for name in ("LL", "W", "LA", "V", ALL)
    ]
