"""The share of a random torque that is left: that of a desired torque whose answer to a step is known."""

from pathlib import Path

import numpy as np
import pytest

from experiments.evaluation.measure.data.random_torque import STEPS_MIN, steps_of, torque_left
from mobnet.core.joints import JointLayout

TIME_S, LAGS_S = 0.05, (0.02, 0.1)  # the first is that of the recording's answer


def test_what_is_left_is_the_answer_to_a_step(explored: Path, layout: JointLayout) -> None:
    """The closed form is share + (1 - share) exp(-lag / time constant)."""
    found = {(what, part): value for what, part, value, _ in torque_left([explored] * 2, layout, ["LL", "W"], LAGS_S)}
    for lag in LAGS_S:
        expected = 0.25 + 0.75 * np.exp(-lag / TIME_S)
        name = f"random torque left after {1000 * lag:g} ms"
        assert found[name, "LL3"] == pytest.approx(expected, abs=0.03)
        assert found[name, "limb LL"] == found[name, "LL3"]
        assert found[name, "W1"] == pytest.approx(1.0, abs=0.02)
    assert {part for _, part in found} == {"LL3", "limb LL", "W1", "limb W"}


def test_a_walk_without_random_torque_has_no_share(data_sets: dict[str, list[Path]], layout: JointLayout) -> None:
    assert not list(torque_left(data_sets["walk"], layout, ["LL", "W"], LAGS_S))


def test_steps_stand_alone_in_one_segment_with_the_leg_in_the_air() -> None:
    random = np.zeros(100)
    for start, value in ((10, 1.0), (30, 2.0), (33, 3.0), (60, -1.0), (88, 2.0)):
        random[start:] = value
    random[59] = 1.0  # the mean of a sample in which the torque steps
    air, whole = np.ones(100, dtype=bool), ((0, 100),)
    assert steps_of(random, air, whole, 10).tolist() == [10, 33, 59, 88]
    assert steps_of(random, air, ((0, 12), (12, 100)), 10).tolist() == [33, 59, 88]
    air[65] = False
    assert steps_of(random, air, whole, 10).tolist() == [10, 33, 88]
    assert steps_of(random, air, whole, 12).tolist() == [10, 33]
    assert STEPS_MIN > 4
