"""Eq. (15): what a model of the uncertainty leaves of the residual."""

import numpy as np

from mobnet.estimation.residual import ResidualEstimator
from mobnet.learning.deployed.networks import Prediction

LIMB = ("LL3", "LL1")  # not in the robot's order
OFFSET = np.array([3.0, -2.0], dtype=np.float32)


class Constant:
    """Predicts the same uncertainty torque always, without a standard deviation."""

    joints = LIMB

    def init(self):
        return None

    def step(self, state, sample):
        return None, Prediction(OFFSET)

    def run_all(self, recordings):
        return [Prediction(np.tile(OFFSET, (len(sensed), 1))) for sensed in recordings]


def test_without_a_model_it_is_the_observer(observer, made_up):
    sensed = made_up(0, 0.1).sensed
    estimator = ResidualEstimator(observer, observer.nominal.robot.layout)
    result = estimator.estimate(sensed)
    assert estimator.joints == observer.nominal.robot.layout.names
    assert result.std is None
    np.testing.assert_array_equal(result.tau_ext, observer.residual(sensed))


def test_a_model_is_subtracted_from_its_own_joints(observer, made_up):
    sensed = made_up(0, 0.1).sensed
    layout = observer.nominal.robot.layout
    estimator, columns = ResidualEstimator(observer, layout, Constant()), layout.columns(LIMB)
    result = estimator.estimate(sensed)
    np.testing.assert_allclose(result.tau_ext, observer.residual(sensed)[:, columns] - OFFSET)
