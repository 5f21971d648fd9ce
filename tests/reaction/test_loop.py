"""A robot walks into obstacles with the observer in its loop, and without force sensors."""

import mujoco
import numpy as np
import pytest

from mobnet.core.columns import recording_columns
from mobnet.plan.jobs import walk_settings
from mobnet.reaction.loop import columns_of, force_on, plan_steps, stop
from mobnet.reaction.trial import contacts_of
from mobnet.settings.load import load_settings
from mobnet.simulation.simulator import Simulator

pytestmark = pytest.mark.sim


@pytest.fixture(scope="module")
def hit(into, leg_watchers):
    """A walk into the block at the foot, with the reaction."""
    return into("foot_block", 1, leg_watchers)


def test_columns_are_those_of_a_recording(layout):
    places = columns_of(layout)
    assert list(places) == list(recording_columns(layout))
    assert places["q"] == slice(0, layout.nq)


def test_the_robot_walks_without_force_sensors_feels_the_block_steps_back_and_stands(hit, layout):
    course, simulator = hit
    assert not course.fallen
    reacted_at, reacted = course.reacted
    (first, *_) = contacts_of(course.force, 1.0, 100)
    assert 0 <= reacted_at - first.start < 50  # ms
    assert reacted.limb == "LL"
    assert reacted.direction[0] < -0.9
    assert np.abs(course.force).max() < 1000.0
    base_x = course.rows[:, columns_of(layout)["q"].start]
    assert base_x[-1] < base_x[reacted_at] - 0.1
    assert simulator.state.standing == 1


def test_without_a_reaction_the_robot_pushes_on(hit, into):
    course, _ = into("foot_block", 1, {})
    assert course.reacted is None
    ours, theirs = (np.linalg.norm(one.force.sum(axis=0)) for one in (hit[0], course))
    assert theirs > 3.0 * ours


def test_the_walk_ends_after_the_contact(into):
    course, _ = into("foot_block", 1, {}, after_s=0.2)
    (first, *_) = contacts_of(course.force, 1.0, 100)
    assert len(course.rows) == first.start + 200


def test_the_force_of_an_obstacle_is_that_of_mujoco_s_contacts():
    """Sum of contact forces with the obstacle, by mj_contactForce, in the step in which they are largest."""
    simulator = Simulator(walk_settings(load_settings(), "foot_block", "ideal"), 1)
    simulator.start()
    model, data = simulator.world.model, simulator.world.data
    simulator.sensors.told[:, 2] = 500.0  # walks on a guess, for long enough to touch the block
    obstacle = {k for k in range(model.ngeom) if model.geom(k).name.startswith("obstacle")}
    row, found = np.zeros((1, simulator.width), np.float32), 0
    data.qpos[0] += 0.6
    for _ in range(300):
        simulator.run(row)
        force = np.zeros(3)
        for k in range(data.ncon):
            contact, own = data.contact[k], np.zeros(6)
            if obstacle & {contact.geom1, contact.geom2}:
                mujoco.mj_contactForce(model, data, k, own)
                sign = -1.0 if contact.geom1 not in obstacle else 1.0
                force += sign * contact.frame.reshape(3, 3).T @ own[:3]
                found += 1
        assert force_on(simulator) == pytest.approx(force, abs=1e-6)
    assert found


def test_reacting_steps_begin_with_the_present_one():
    simulator = Simulator(walk_settings(load_settings(), "foot_block", "ideal"), 1)
    simulator.start()
    simulator.state.steps = 4
    steps = np.arange(15.0).reshape(3, 5)
    commands = plan_steps(simulator.state, steps)
    assert (simulator.state.command == steps[0]).all()
    assert (commands[4:] == steps).all()
    simulator.state.steps, simulator.state.swinging, simulator.state.t = 6, 0, 0.1
    stop(simulator.state, len(commands))
    assert simulator.state.standing == 0  # the last step is still to be made
    simulator.state.steps = 7
    stop(simulator.state, len(commands))
    assert simulator.state.standing == 1
