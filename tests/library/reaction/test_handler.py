"""The pipeline sample by sample: alarm, limb, waiting time, footsteps that are kept, and one reaction only."""

from dataclasses import replace

import mujoco
import numpy as np
import pytest

from mobnet.core.estimator import Estimate
from mobnet.core.recording import Sensed
from mobnet.formats.plain import as_plain
from mobnet.reaction.handler import Handler
from mobnet.reaction.numbers import ReactionNumbers
from mobnet.robot.plant import robot_spec

COMMAND = np.array([0.15, 0.0, 0.0, 0.7, 0.05])
PUSH_N = 80.0


class Alarm:
    """Watches nothing and raises an alarm at a sample."""

    def __init__(self, at, ratio=2.0):
        self.at, self.height = at, ratio

    def init(self):
        return [0]

    def ratio(self, state, sample, estimate):
        state[0] += 1
        return self.height if state[0] - 1 >= self.at else 0.0


def sample_of(layout, left_swings, right_swings, landing=0.3):
    q = np.zeros(layout.nq)
    q[3] = 1.0
    zeros = np.zeros(layout.nu)
    swing = np.array([left_swings, right_swings], float)
    return Sensed(q, np.zeros(layout.nv), np.zeros(3), zeros, zeros, swing, COMMAND, landing * swing)


def handler_of(robot, settings, watchers, strategy="compliant", delay=0):
    return Handler(
        robot, as_plain(settings.reaction, ReactionNumbers), settings.walking.foot_spacing_m, watchers, strategy, delay
    )


@pytest.fixture(scope="module")
def model(robot):
    return robot_spec(robot).compile()


@pytest.fixture(scope="module")
def estimate_of(model, robot):
    """A function of a horizontal force -> the torque of all joints if it pushes the left foot of the upright robot."""

    def make(push=(-PUSH_N, 0.0)):
        data, tau = mujoco.MjData(model), np.zeros(model.nv)
        data.qpos[:] = 0.0
        data.qpos[3] = 1.0
        mujoco.mj_kinematics(model, data)
        mujoco.mj_comPos(model, data)
        body = robot.feet["left"].body
        mujoco.mj_applyFT(
            model, data, np.array([*push, 0.0]), np.zeros(3), data.body(body).xpos, model.body(body).id, tau
        )
        return Estimate(tau)

    return make


def run(handler, samples, estimate):
    """Return the reactions, sample by sample."""
    state = handler.init()
    return [handler.step(state, sample, estimate) for sample in samples]


def test_the_highest_limb_reacts_once_after_its_waiting_time(robot, settings, layout, estimate_of):
    handler = handler_of(robot, settings, {"LL": Alarm(3), "RA": Alarm(3, ratio=5.0)}, delay=2)
    found = run(handler, [sample_of(layout, 1, 0)] * 10, estimate_of())
    assert [k for k, one in enumerate(found) if one is not None] == [5]
    assert found[5].limb == "RA"


def test_nothing_is_an_alarm_before_filters_have_settled(robot, settings, layout, estimate_of):
    spacing_m = settings.walking.foot_spacing_m
    handler = Handler(
        robot, as_plain(settings.reaction, ReactionNumbers), spacing_m, {"LL": Alarm(0)}, "compliant", settle=5
    )
    found = run(handler, [sample_of(layout, 1, 0)] * 8, estimate_of())
    assert [k for k, one in enumerate(found) if one is not None] == [4]


def test_nothing_happens_below_the_threshold(robot, settings, layout, estimate_of):
    handler = handler_of(robot, settings, {"LL": Alarm(0, ratio=1.0)})
    assert run(handler, [sample_of(layout, 1, 0)] * 5, estimate_of()) == [None] * 5


@pytest.mark.parametrize("push", [(-PUSH_N, 0.0), (0.0, PUSH_N), (30.0, -40.0)])
def test_the_direction_is_that_of_the_unexpected_force(robot, settings, layout, estimate_of, push):
    handler = handler_of(robot, settings, {"LL": Alarm(2)})
    reacted = run(handler, [sample_of(layout, 1, 0)] * 4, estimate_of(push))[2]
    assert reacted.wrench[:2] == pytest.approx(push, abs=0.1)  # (24), of a robot that stands on the other foot
    assert reacted.direction == pytest.approx(np.array(push) / np.hypot(*push), abs=0.02)


def test_steps_end_in_place_and_there_are_as_many_as_asked(robot, settings, layout, estimate_of):
    reaction = settings.reaction
    handler = handler_of(robot, settings, {"LL": Alarm(2)})
    steps = run(handler, [sample_of(layout, 1, 0)] * 4, estimate_of())[2].steps
    assert len(steps) == reaction.compliant.steps + reaction.stop_steps
    assert not steps[-reaction.stop_steps :, :3].any()
    assert steps[1, 0] == pytest.approx(-reaction.compliant.step_m)
    assert steps[:, 3] == pytest.approx([COMMAND[3], *[reaction.step_s] * (len(steps) - 1)])


def test_a_robot_that_steps_faster_than_reacting_steps_keeps_its_pace(robot, settings, layout, estimate_of):
    quick_s = 0.8 * settings.reaction.step_s
    sample = sample_of(layout, 1, 0)
    quick = replace(sample, command=np.array([*COMMAND[:3], quick_s, *COMMAND[4:]]))
    steps = run(handler_of(robot, settings, {"LL": Alarm(2)}), [quick] * 4, estimate_of())[2].steps
    assert steps[:, 3] == pytest.approx(quick_s)


def test_a_robot_whose_filters_have_settled_reacts_however_late_it_is_hit(robot, settings, layout, estimate_of):
    spacing_m = settings.walking.foot_spacing_m
    handler = Handler(
        robot, as_plain(settings.reaction, ReactionNumbers), spacing_m, {"LL": Alarm(8)}, "compliant", settle=2
    )
    found = run(handler, [sample_of(layout, 1, 0)] * 10, estimate_of())
    assert [k for k, one in enumerate(found) if one is not None] == [8]


def test_rewinding_knows_where_feet_have_stood(robot, settings, layout, estimate_of):
    """Two steps in place: the feet stand where they stood, so that the way back is in place too."""
    handler = handler_of(robot, settings, {"LL": Alarm(9)}, strategy="rewind")
    gait = [(0, 0), (1, 0), (1, 0), (0, 0), (0, 1), (0, 1), (0, 0), (1, 0), (1, 0), (1, 0)]
    steps = run(handler, [sample_of(layout, *feet) for feet in gait], estimate_of())[9].steps
    assert len(steps) == 3 + settings.reaction.stop_steps  # three feet have left the ground
    assert np.abs(steps[:, 0]).max() < 1e-9


@pytest.mark.parametrize(("gait", "swing"), [
    ([(0, 0), (1, 0)], 0), ([(1, 0), (1, 0)], 0), ([(1, 0), (0, 0)], 1), ([(1, 0), (0, 0), (0, 1), (0, 1)], 1),
    ([(0, 1), (0, 0), (0, 0)], 0),
])  # fmt: skip
def test_a_foot_in_the_air_swings_and_then_the_one_that_stood_longer(robot, settings, layout, estimate_of, gait, swing):
    handler = handler_of(robot, settings, {"LL": Alarm(99)})
    state = handler.init()
    for feet in gait:
        handler.step(state, sample_of(layout, *feet), estimate_of())
    assert state.swing == swing


def test_a_robot_that_is_hit_while_both_feet_stand_lets_the_next_foot_go(robot, settings, layout, estimate_of):
    handler = handler_of(robot, settings, {"LL": Alarm(4)})
    gait = [(0, 0), (1, 0), (0, 0), (0, 0), (0, 0)]
    steps = run(handler, [sample_of(layout, *feet) for feet in gait], estimate_of())[4].steps
    assert steps[0, 0] == pytest.approx(-settings.reaction.compliant.step_m)  # its whole length: it is not in the air
