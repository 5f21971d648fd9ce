"""The gate opens in the middle of a swing, as the plan has it, and closes for good when the foot meets the ground."""

import numpy as np
import pytest
from made_swings import AIR, GROUND, bent_to

from mobnet.detection.gate import make_gate
from mobnet.detection.leg import foot_load, unit_torques
from mobnet.formats.plain import as_plain
from mobnet.kernel.detecting import GateNumbers

LATE = GROUND + AIR - 120  # when the plan and the pose let the foot meet the ground


def ground_torque(robot, gate, q, force):
    """Return the torques of the leg's joints (6,) under a force on its foot (3,) [N], world axes."""
    assert foot_load(gate.leg, q, np.zeros(6))
    jacobian = np.zeros((6, 6))
    for j in range(6):
        one = np.eye(6)[j]
        assert foot_load(gate.leg, q, one)
        jacobian[:, j] = gate.leg.load
    return np.linalg.solve(jacobian, np.concatenate([force, np.zeros(3)]))


def test_a_leg_is_watched_away_from_both_ends_of_its_swing(gate, walk):
    sensed = walk(2)
    watch = gate.run(sensed, np.zeros((len(sensed), 6)))
    for first in (GROUND, 2 * GROUND + AIR):
        # open from the 90th sample in the air on, while more than 30 ms are left
        assert np.flatnonzero(watch.watched[first : first + AIR]).tolist() == list(range(89, AIR - 30))
        assert not watch.watched[first - 100 : first].any()
    assert watch.phase[GROUND + 175] == pytest.approx(0.5, abs=0.01)


def test_an_early_contact_closes_the_gate_for_the_rest_of_the_swing(gate, walk, robot):
    sensed = walk(2)
    tau = np.zeros((len(sensed), 6))
    tau[LATE : LATE + 6] = ground_torque(robot, gate, sensed.q[0], np.array([5.0, 0.0, 60.0]))
    watch = gate.run(sensed, tau)
    assert watch.watched[LATE + 3]
    assert not watch.watched[LATE + 4 : GROUND + AIR].any()  # five samples later
    assert watch.watched[2 * GROUND + AIR + 100 : 2 * GROUND + 2 * AIR - 31].all()  # the next swing is watched again


@pytest.mark.parametrize(("force", "samples"), [
    ([60.0, 0.0, 20.0], 50), ([0.0, 0.0, 30.0], 50), ([0.0, 0.0, 60.0], 4),
], ids=["flat", "weak", "short"])  # fmt: skip
def test_what_does_not_look_like_the_ground_leaves_the_gate_open(gate, walk, robot, force, samples):
    sensed = walk(1)
    tau = np.zeros((len(sensed), 6))
    tau[LATE : LATE + samples] = ground_torque(robot, gate, sensed.q[0], np.array(force))
    assert gate.run(sensed, tau).watched[GROUND + 100 : GROUND + AIR - 31].all()


@pytest.mark.parametrize(("raised_rad", "from_landing"), [(0.0, 200), (0.5, 120)], ids=["long before", "high"])
def test_the_ground_is_not_met_long_before_the_landing_or_high_above_it(gate, walk, robot, raised_rad, from_landing):
    sensed, first = bent_to(walk(1), robot.layout, raised_rad), GROUND + AIR - from_landing
    tau = np.zeros((len(sensed), 6))
    tau[first : first + 50] = ground_torque(robot, gate, sensed.q[0], np.array([5.0, 0.0, 60.0]))
    assert gate.run(sensed, tau).watched[first : GROUND + AIR - 31].all()


@pytest.mark.parametrize("link", ["foot", "ankle", "knee"])
def test_a_hit_from_the_front_is_no_ground(gate, walk, robot, link):
    sensed = walk(1)
    hit = 150.0 * unit_torques(robot, gate.leg, sensed.q[0], [f"left_{link}_front"], -1.0)[0]
    hit[2] *= 0.5  # an estimate that sees half of the hip's torque turns the force upwards
    tau = np.zeros((len(sensed), 6))
    tau[GROUND + 100 : GROUND + 178] = hit
    assert gate.run(sensed, tau).watched[GROUND + 100 : GROUND + AIR - 31].all()


def test_times_of_the_gate_are_a_sample_at_least(settings):
    """At a rate at which they are shorter than half a sample."""
    gate = make_gate(as_plain(settings.detection.gate, GateNumbers), 1.0)
    assert (gate.lift_off, gate.hold) == (1, 1)
