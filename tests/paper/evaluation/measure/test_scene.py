"""Phases of the gait from flags with known times, and what an estimate shows of a push."""

import numpy as np

from experiments.evaluation.compare.scene import STANCE, SWINGING, TOUCH_DOWN, gait_phases


def flags(length: int, *spans: tuple[int, int]) -> np.ndarray:
    """Return a flag (length,) that is set in spans."""
    held = np.zeros(length, dtype=bool)
    for start, end in spans:
        held[start:end] = True
    return held


def test_phases_are_swing_touch_down_and_stance_and_always_one_of_them() -> None:
    swing, contact = flags(400, (100, 200), (300, 390)), flags(400, (0, 110), (190, 305), (385, 400))
    found = gait_phases(swing, contact, ((0, 400),), 20)
    np.testing.assert_array_equal(found[TOUCH_DOWN], flags(400, (190, 210), (385, 400)))
    np.testing.assert_array_equal(found[SWINGING], flags(400, (110, 190), (305, 385)))
    assert (sum(held.astype(int) for held in found.values()) == 1).all()


def test_a_contact_that_bounces_is_one_touch_down_and_one_that_begins_a_span_is_none() -> None:
    swing, contact = flags(200, (50, 100)), flags(200, (0, 50), (100, 103), (106, 200))
    found = gait_phases(swing, contact, ((0, 200),), 20)
    np.testing.assert_array_equal(found[TOUCH_DOWN], flags(200, (100, 120)))
    assert not gait_phases(swing, flags(200, (0, 200)), ((0, 200),), 20)[TOUCH_DOWN].any()
    assert found[STANCE][:50].all()


def test_a_touch_down_does_not_reach_into_the_next_span() -> None:
    contact = flags(200, (95, 200))
    found = gait_phases(~contact, contact, ((0, 100), (100, 200)), 20)
    np.testing.assert_array_equal(found[TOUCH_DOWN], flags(200, (95, 100)))
