"""A robot that follows a trajectory known in closed form, and what its sensors read on the way."""

from dataclasses import dataclass

import numpy as np
import pytest
from numpy.typing import NDArray

from mobnet.core.columns import COMMAND, FEET
from mobnet.core.recording import Sensed
from mobnet.estimation.observer import RobotObserver
from mobnet.robot.dynamics import inverse_dynamics

SUB_STEPS = 2  # plant ticks in a sample
Array = NDArray[np.float64]


@dataclass(frozen=True)
class Wave:
    """amplitude * sin(2 pi frequency t + phase), each (n,), and its derivatives."""

    amplitude: Array
    frequency_hz: Array
    phase: Array

    def __call__(self, t):
        """Return value, first and second derivative at t [s]."""
        rate = 2 * np.pi * self.frequency_hz
        angle = rate * t + self.phase
        sine, cosine = self.amplitude * np.sin(angle), self.amplitude * np.cos(angle)
        return sine, rate * cosine, -(rate**2) * sine


@dataclass(frozen=True)
class Trajectory:
    """Position and roll, pitch, yaw of the base and all joints as waves."""

    wave: Wave

    def __call__(self, t):
        """Return q (nq,), v (nv,) and its derivative (nv,) at t [s]."""
        x, dx, ddx = self.wave(t)
        quat, omega, alpha = base_rotation(x[3:6], dx[3:6], ddx[3:6])
        q = np.concatenate([x[:3], quat, x[6:]])
        v = np.concatenate([dx[:3], omega, dx[6:]])
        return q, v, np.concatenate([ddx[:3], alpha, ddx[6:]])


def base_rotation(x, dx, ddx):
    """Return quaternion w x y z, angular velocity and acceleration in base axes from roll, pitch, yaw (3,)."""
    (sr, cr), (sp, cp) = (np.sin(x[0]), np.cos(x[0])), (np.sin(x[1]), np.cos(x[1]))
    euler = np.array([[1, 0, -sp], [0, cr, cp * sr], [0, -sr, cp * cr]])
    roll_rate = np.array([[0, 0, 0], [0, -sr, cp * cr], [0, -cr, -cp * sr]]) * dx[0]
    pitch_rate = np.array([[0, 0, -cp], [0, 0, -sp * sr], [0, 0, -sp * cr]]) * dx[1]
    (a, b), (c, d), (e, f) = ((np.cos(angle / 2), np.sin(angle / 2)) for angle in x)
    quat = np.array([a * c * e + b * d * f, b * c * e - a * d * f, a * d * e + b * c * f, a * c * f - b * d * e])
    return quat, euler @ dx, euler @ ddx + (roll_rate + pitch_rate) @ dx


@pytest.fixture(scope="session")
def trajectory(robot):
    """All joints swing at a few tenths of a radian and one or two Hertz, each in its own time."""
    rng, nv = np.random.default_rng(7), robot.layout.nv
    return Trajectory(Wave(rng.uniform(0.1, 0.3, nv), rng.uniform(0.7, 2.0, nv), rng.uniform(0, 2 * np.pi, nv)))


def sensed_of(q, v, tau):
    """Return what a robot senses from positions (T, nq), velocities (T, nv) and motor torques (T, nu)."""
    samples = len(q)
    flags, command = np.zeros((samples, len(FEET))), np.zeros((samples, len(COMMAND)))
    return Sensed(q, v, np.zeros((samples, 3)), tau, tau, flags, command, flags)


@pytest.fixture
def follow(nominal, trajectory):
    """A function rate_hz, seconds, external (nu,) [N m] -> what is sensed, and the true external torque (T, nv).

    Motors give what the motion needs less the external torque, which starts with the first sample; the base has no
    motors, so all it needs is external. Torques are means over the sub-steps of a sample.
    """

    def run(rate_hz, seconds, external):
        times = np.arange(round(seconds * rate_hz) + 1) / rate_hz
        states = [trajectory(t) for t in times]
        middles = (np.arange(SUB_STEPS) + 0.5) / SUB_STEPS - 1
        needed = np.array(
            [np.mean([inverse_dynamics(nominal, *trajectory(t + m / rate_hz)) for m in middles], 0) for t in times]
        )
        truth = np.concatenate([needed[:, :6], np.tile(external, (len(times), 1))], axis=1)
        q, v = (np.stack([state[i] for state in states]) for i in range(2))
        return sensed_of(q, v, needed[:, 6:] - external), truth

    return run


@pytest.fixture
def observer(nominal):
    return RobotObserver(nominal, 100.0, 1000.0)


@pytest.fixture
def changed_joints(recipe_of, layout, made_up):
    """Return a function of a kind's `build`, a method and its fit: the joints whose estimate is not the residual."""

    def changed(build, name, fitted):
        recipe, sensed = recipe_of(name, fitted=fitted), made_up(2, 0.1).sensed
        estimator = build(recipe)
        assert estimator.joints == layout.names
        difference = estimator.estimate(sensed).tau_ext - recipe.observer().residual(sensed)
        return [joint for joint, column in zip(estimator.joints, difference.T, strict=True) if column.any()]

    return changed
