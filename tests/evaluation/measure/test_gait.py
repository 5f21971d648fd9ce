"""A gait cycle begins at a lift-off, ends at the next, and lies within one segment."""

from collections.abc import Callable

import numpy as np
import pytest

from mobnet.core.errors import ConfigError, DataError
from mobnet.core.joints import JointLayout
from mobnet.evaluation.measure.curves import gait_cycle, read_cycle
from mobnet.evaluation.measure.windows import foot_of
from mobnet.plan.runs import Run

Walk = Callable[..., Run]
AIR = np.array([1, 1, 0, 0, 0, 1, 1, 0, 0, 1, 1, 0, 1, 0, 0, 1], dtype=bool)  # lift-offs at 5, 9, 12, 15
WHOLE = ((0, len(AIR)),)


@pytest.mark.parametrize(("start", "rows"), [(0, (5, 9)), (5, (9, 12)), (4, (5, 9)), (6, (9, 12)), (11, (12, 15))])
def test_cycle_goes_from_the_first_lift_off_after_the_start_to_the_next(start: int, rows: tuple[int, int]) -> None:
    assert gait_cycle(AIR, WHOLE, start) == slice(*rows)


def test_every_cycle_is_one_swing_and_one_stance() -> None:
    for start in range(11):
        rows = gait_cycle(AIR, WHOLE, start)
        assert rows is not None
        swing = AIR[rows]
        assert swing[0]
        assert not swing[-1]
        assert np.count_nonzero(np.diff(swing.astype(int))) == 1


def test_cycle_does_not_cross_a_fall() -> None:
    assert gait_cycle(AIR, ((0, 8), (8, 16)), 0) == slice(9, 12)


def test_no_cycle_is_none() -> None:
    assert gait_cycle(AIR, WHOLE, 13) is None
    assert gait_cycle(np.ones(10, dtype=bool), ((0, 10),), 0) is None


def test_cycle_of_a_recording_is_that_of_the_joints_own_foot(walk: Walk, layout: JointLayout) -> None:
    curves, rows = read_cycle(layout, [walk(2.0)], ["LL3"], 1.0)
    assert rows.stop - rows.start == 140
    assert curves.flags["swing"][rows].sum() == 70
    with pytest.raises(DataError, match=r"no whole gait cycle after 100\.0 s; it lasts 5\.6 s"):
        read_cycle(layout, [walk(2.0)], ["LL3"], 100.0)


def test_a_foot_belongs_to_its_leg(layout: JointLayout) -> None:
    assert (foot_of(layout, "LL3"), foot_of(layout, "RL6")) == ("left_foot", "right_foot")
    with pytest.raises(ConfigError, match="leg joint: 'LA1' is not accepted"):
        foot_of(layout, "LA1")
