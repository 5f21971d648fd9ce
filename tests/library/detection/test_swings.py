"""Whole swings of a leg, the largest numbers in them, and the episode that each belongs to."""

import numpy as np

from mobnet.detection.gate import episodes_of, largest, segment_of, swings_of


def test_only_whole_swings_count():
    swing = np.array([1, 1, 0, 0, 1, 1, 1, 0, 1, 1, 0, 0, 1, 1, 0, 1])
    assert swings_of(swing, [(0, 10), (10, 16)]) == ((4, 7), (12, 14))


def test_the_largest_number_of_each_swing():
    values = np.array([[0.0, 9.0], [2.0, 1.0], [5.0, 0.0], [7.0, 7.0]])
    np.testing.assert_array_equal(largest(values, [(0, 2), (1, 3)]), [[2.0, 9.0], [5.0, 1.0]])
    assert largest(values, []).shape == (0, 2)


def test_episodes_are_counted_over_recordings():
    walks = [(((0, 10), (10, 20)), ((1, 3), (12, 15))), (((0, 9),), ((2, 4), (6, 8)))]
    assert episodes_of(walks) == [0, 1, 2, 2]
    assert segment_of((12, 15), ((0, 10), (10, 20))) == 1
