"""The share of a long push that an estimate shows, of pushes whose share is known."""

import numpy as np
import pytest

from experiments.evaluation.measure.estimates.drift import calm_rows, share_shown, step_numbers


@pytest.mark.parametrize("share", [0.0, 0.4, 1.0, 1.3])
def test_a_share_of_the_push_is_found_beside_errors_that_do_not_go_with_it(
    share: float, rng: np.random.Generator
) -> None:
    push = np.full((5000, 2), [20.0, -10.0])
    error = (share - 1.0) * push + rng.normal(size=push.shape) * 5.0
    assert share_shown(push, error) == pytest.approx(share, abs=0.02)
    aside = np.full((5000, 2), [10.0, 20.0])  # an error at right angles to the push
    assert share_shown(push, (share - 1.0) * push + aside) == pytest.approx(share, abs=1e-9)


def test_without_a_push_there_is_no_share() -> None:
    assert np.isnan(share_shown(np.zeros((5, 2)), np.ones((5, 2))))


def test_steps_are_numbered_from_the_beginning_of_each_push_and_parted_in_the_middle_of_the_others() -> None:
    air = np.tile(np.repeat([False, True], 10), 4)  # stances of 10 rows, then swings of 10
    pushed = np.zeros(80, dtype=bool)
    pushed[12:56] = pushed[70:80] = True
    swings, stances = step_numbers(pushed, air, ((0, 80),))
    np.testing.assert_array_equal(np.flatnonzero(swings == 1), [*range(12, 25), *range(70, 80)])
    np.testing.assert_array_equal(np.flatnonzero(swings == 2), range(25, 45))
    np.testing.assert_array_equal(np.flatnonzero(swings == 3), range(45, 56))
    np.testing.assert_array_equal(np.flatnonzero(stances == 1), [*range(12, 15), *range(70, 75)])
    np.testing.assert_array_equal(np.flatnonzero(stances == 2), [*range(15, 35), *range(75, 80)])
    assert not swings[~pushed].any()
    assert not stances[~pushed].any()


def test_a_whole_swing_has_one_number_even_where_the_foot_lifts_off_late_and_lands_early() -> None:
    planned = np.tile(np.repeat([False, True], 10), 4)
    actual = planned.copy()
    actual[[10, 11, 19, 30, 39]] = False
    swings, stances = step_numbers(np.ones(80, dtype=bool), planned, ((0, 80),))
    assert set(swings[10:20][actual[10:20]]) == {swings[15]}
    assert stances[11] == stances[5]
    assert stances[19] == stances[25]


def test_calm_begins_some_time_after_a_push() -> None:
    pushed = np.zeros(20, dtype=bool)
    pushed[3:6] = pushed[12:14] = True
    calm = calm_rows(pushed, ((0, 10), (10, 18)), 2)
    np.testing.assert_array_equal(np.flatnonzero(calm), [0, 1, 2, 8, 9, 10, 11, 16, 17])
