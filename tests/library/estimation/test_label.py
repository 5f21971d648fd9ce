"""The label of the foot sensors: zeroed readings mapped to the joints, freed of the inertia below the sensors."""

from dataclasses import replace

import numpy as np
import pinocchio as pin
import pytest

from mobnet.core.recording import SensedRecording
from mobnet.estimation.label import foot_label, zero_of
from mobnet.kernel.low_pass import low_pass
from mobnet.robot.wrench import feet_torque

RATE_HZ, GAIN_HZ = 1000.0, 100.0
SEGMENTS = ((0, 100), (100, 200))


@pytest.fixture
def read(follow, robot):
    """Two segments of a tenth of a second in which the left foot swings and the right one stands."""
    sensed, _ = follow(RATE_HZ, 0.199, np.zeros(robot.layout.nu))
    sensed = replace(sensed, swing=np.tile([1.0, 0.0], (len(sensed), 1)))
    return SensedRecording(sensed, SEGMENTS, RATE_HZ, {})


@pytest.fixture
def resisted(nominal, robot, read):
    """What the sensor of a foot reads that nothing touches: minus mass times acceleration of the plate below (T, 6)."""

    def of(side):
        model, data, frame = nominal.model, nominal.model.createData(), nominal.foot_frames[side]
        arm, places, turns = np.subtract(robot.sole.plate_com, robot.sole.sensor_pos), [], []
        for q in nominal.positions(read.sensed.q):
            pin.framesForwardKinematics(model, data, q)
            places.append(data.oMf[frame].act(arm))
            turns.append(data.oMf[frame].rotation.T.copy())
        # These central differences are half a sample later than (O1), which makes the tolerance below.
        acc = np.gradient(np.gradient(np.array(places), axis=0), axis=0) * RATE_HZ**2
        force = -robot.sole.plate_kg * np.einsum("tij,tj->ti", np.array(turns), acc)
        return np.concatenate([force, np.cross(arm, force)], axis=1)

    return of


def test_the_inertia_of_the_plate_leaves_the_label_of_a_foot_in_the_air(nominal, read, resisted):
    """All that is left is the median of the reading, which zeroing takes for the error of the sensor."""
    wrench = resisted("left")
    wrenches = {"left": wrench, "right": np.zeros_like(wrench)}
    raw, label = (foot_label(nominal, read, wrenches, GAIN_HZ, plates=plates) for plates in (False, True))
    median = -np.median(wrench, axis=0) * np.ones_like(wrench)
    left = low_passed(feet_torque(nominal, read.sensed.q, {"left": median}))
    rows = np.r_[50:98, 150:198]  # gradients at the ends of the motion are one-sided
    assert np.abs((raw - left)[rows]).max() > 10.0
    np.testing.assert_allclose(label[rows], left[rows], atol=0.5)


def low_passed(torque):
    return np.concatenate([low_pass(torque[start:end], GAIN_HZ, RATE_HZ) for start, end in SEGMENTS])


def test_a_foot_on_the_ground_is_at_rest(nominal, read):
    """Whatever the encoders say of it: without a reading there is no label, and each segment starts anew."""
    still = replace(read, sensed=replace(read.sensed, swing=np.zeros((200, 2))))
    wrenches = {side: np.random.default_rng(0).normal(0.0, 100.0, (200, 6)) for side in ("left", "right")}
    label = foot_label(nominal, still, wrenches, GAIN_HZ)
    np.testing.assert_allclose(label, low_passed(feet_torque(nominal, read.sensed.q, wrenches)), atol=1e-9)


def test_a_foots_sensor_is_zeroed_where_the_foot_swings():
    """A push on the foot in the swing does not matter; without a swing the reading stays as it is."""
    swing, wrench = np.repeat([0, 1, 0], 100), np.full((300, 6), 5.0)
    wrench[swing == 0] += 400.0
    wrench[120:140] += 80.0
    np.testing.assert_allclose(zero_of(wrench[swing > 0]), 5.0)
    np.testing.assert_array_equal(zero_of(wrench[:0]), 0.0)
