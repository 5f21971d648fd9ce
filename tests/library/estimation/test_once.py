"""What several run on the same samples takes each of them once, with the numbers of one's own."""

import numpy as np

from mobnet.core.estimator import once
from mobnet.estimation.observe import observer_of


class Sum:
    """A sum over all samples, and how many steps were made."""

    joints = ("A",)

    def __init__(self):
        self.steps = 0

    def init(self):
        return 0

    def step(self, state, sample):
        self.steps += 1
        return state + sample[0], state + sample[0]


def test_a_sample_is_taken_once_whoever_asks_first():
    counted = Sum()
    shared = once(counted)
    states = [shared.init() for _ in range(3)]
    found = []
    for k in range(4):
        sample = [k + 1000]
        for who in (0, 1, 2) if k % 2 else (2, 0, 1):
            states[who], value = shared.step(states[who], sample)
            found.append(value)
    assert found == [total for total in (1000, 2001, 3003, 4006) for _ in range(3)]
    assert counted.steps == 4
    assert shared.joints == ("A",)


def test_another_state_or_another_sample_is_another_step():
    """Two walks, or one of those that run it left out a sample."""
    shared = once(Sum())
    first, second, third = [1000], [2000], [3000]
    state, _ = shared.step(shared.init(), first)
    assert shared.step(shared.init(), second)[1] == 2000
    assert shared.step(state, second)[1] == 3000
    assert shared.step(state, third)[1] == 4000
    assert shared.step(shared.init(), first)[1] == 1000


def test_an_observer_that_is_shared_gives_its_residual_from_each_start(robot, made_up):
    sensed = made_up(4, 0.05).sensed
    observer = observer_of(robot, 1.0, 9.81, 50.0, 1000.0)
    shared, expected = once(observer), observer.residual(sensed)
    for _ in range(2):
        states = [shared.init(), shared.init()]
        for k in range(len(sensed)):
            sample = sensed[k]
            for who in range(2):
                states[who], residual = shared.step(states[who], sample)
                np.testing.assert_allclose(residual, expected[k], rtol=1e-12, atol=1e-9)
        assert states[0] is states[1]
