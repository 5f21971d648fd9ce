"""Which samples are looked at."""

from pathlib import Path

import numpy as np
import pytest

from experiments.evaluation.compare.windows import Pushed, blocks_of, evenly, flagged_spans, push_windows, pushed_of
from experiments.settings.evaluation import Evaluation
from experiments.settings.measures import CoverageTest
from mobnet.core.columns import recording_columns
from mobnet.core.errors import DataError
from mobnet.core.joints import JointLayout
from mobnet.core.store import write_array

PUSHED = Pushed("LL3", 5.0, 0.02)


def test_a_span_holds_the_flags_and_what_comes_after_within_its_segment() -> None:
    flags = np.isin(np.arange(30), [3, 4, 8, 9, 18, 29])
    assert flagged_spans(flags, ((0, 20), (20, 30)), 2) == ((3, 7), (8, 12), (18, 20), (29, 30))
    assert flagged_spans(flags, ((0, 20),), 4) == ((3, 14), (18, 20))
    assert flagged_spans(np.zeros(30, dtype=bool), ((0, 30),), 2) == ()


def test_blocks_tile_the_spans() -> None:
    """Identity: end to end the blocks are the spans."""
    blocks = list(blocks_of(((0, 25), (40, 50)), 10))
    assert blocks == [(0, 10), (10, 20), (20, 25), (40, 50)]


@pytest.mark.parametrize(("total", "count"), [(10, 3), (3, 10), (100, 7), (5, 5), (0, 4)])
def test_samples_are_spread_evenly_without_a_repeat(total: int, count: int) -> None:
    """In order, from the first on, no two steps further apart than one."""
    taken = evenly(total, count)
    assert len(taken) == min(total, count)
    assert len(set(taken.tolist())) == len(taken)
    if len(taken) > 1:
        assert np.ptp(np.diff(taken)) <= 1
        assert taken[0] == 0
        assert total - taken[-1] <= np.diff(taken).max() + 1


def test_a_push_is_torque_on_a_leg_that_touches_nothing(tmp_path: Path, layout: JointLayout) -> None:
    columns = [column for group in recording_columns(layout).values() for column in group]
    array = np.zeros((100, len(columns)))
    where = {name: k for k, (name, _, _) in enumerate(columns)}
    array[:, where["swing.left_foot"]] = 1.0
    array[[10, 40, 70], where["tau_ext.LL3"]] = [-30.0, 30.0, 4.0]
    array[35:50, where["contact.left_foot"]] = 1.0
    write_array(tmp_path / "r", array, columns, {"rate_hz": 100.0}, [(0, 100)])
    assert PUSHED.spans(tmp_path / "r") == ((10, 13),)
    assert Pushed("LL3", 5.0, 0.02, leg=False).spans(tmp_path / "r") == ((10, 13), (40, 43))


@pytest.mark.parametrize(
    ("joint", "pushed"), [(None, None), ("LL3", PUSHED), ("RA2", Pushed("RA2", 5.0, 0.02, leg=False))]
)
def test_only_a_test_that_names_a_joint_is_about_pushes(
    joint: str | None, pushed: Pushed | None, evaluation: Evaluation
) -> None:
    settings = evaluation.coverage.model_copy(update={"push_after_s": 0.02})
    assert pushed_of(CoverageTest(scenario="knee_swing", level="all_uncertainty", pushed=joint), settings) == pushed


def test_a_window_is_a_push_with_what_is_before_and_after_it_in_its_segment(tmp_path: Path) -> None:
    pushed = np.isin(np.arange(100), [1, 2, 40, 41, 42, 58, 59, 99]).astype(float)
    write_array(
        tmp_path / "r", pushed[:, None], [("pushed", "-", "scenario")], {"rate_hz": 100.0}, [(0, 60), (60, 100)]
    )
    assert push_windows(tmp_path / "r", 100, 0.0, 0.0) == ((1, 3), (40, 43), (58, 60), (99, 100))
    assert push_windows(tmp_path / "r", 100, 0.03, 0.05) == ((0, 8), (37, 48), (55, 60), (96, 100))
    with pytest.raises(DataError, match="rows is 100, but its estimates have 90"):
        push_windows(tmp_path / "r", 90, 0.0, 0.0)
