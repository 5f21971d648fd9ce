"""The share of a long push that an estimate shows, of pushes whose share is known."""

import numpy as np
import pytest

from mobnet.evaluation.measure.estimates.drift import calm_rows, rows_since, share_shown


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


def test_time_is_counted_from_the_beginning_of_each_push_and_calm_begins_some_time_after_it() -> None:
    pushed = np.zeros(20, dtype=bool)
    pushed[3:6] = pushed[12:14] = True
    since = rows_since(pushed, ((0, 10), (10, 20)))
    np.testing.assert_array_equal(np.flatnonzero(since >= 0), [3, 4, 5, 12, 13])
    np.testing.assert_array_equal(since[since >= 0], [0, 1, 2, 0, 1])
    calm = calm_rows(pushed, ((0, 10), (10, 18)), 2)
    np.testing.assert_array_equal(np.flatnonzero(calm), [0, 1, 2, 8, 9, 10, 11, 16, 17])
