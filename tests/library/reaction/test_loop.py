"""A robot walks into obstacles with the observer in its loop, and without force sensors."""

import mujoco
import numpy as np
import pytest
from library_settings import library_settings, walk_settings
from made_weights import weights

from mobnet.core.columns import recording_columns
from mobnet.estimation.residual import ResidualEstimator
from mobnet.formats.network import Limb, NetworkCell
from mobnet.formats.plain import as_plain
from mobnet.learning.deployed.limbs import LimbNetworks
from mobnet.learning.deployed.loading import deployed
from mobnet.learning.deployed.networks import Prediction
from mobnet.learning.features import limb_inputs, signal_names, signals
from mobnet.reaction.handler import Handler
from mobnet.reaction.loop import columns_of, force_on, give_way, plan_steps, stop, walk_with
from mobnet.reaction.numbers import ReactionNumbers
from mobnet.simulation.simulator import Simulator

pytestmark = pytest.mark.sim


def first_contact(force):
    """Return the samples of the first touch by more than 1 N, which may bounce for a tenth of a second."""
    touching = np.flatnonzero(np.linalg.norm(force, axis=1) > 1.0)
    ends = [*np.flatnonzero(np.diff(touching) > 100), len(touching) - 1]
    return slice(int(touching[0]), int(touching[ends[0]]) + 1)


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
    first = first_contact(course.force)
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
    first = first_contact(course.force)
    assert len(course.rows) == first.start + 200


@pytest.mark.parametrize(("scenario", "limb"), [("hand_held", "RA"), ("side_push", "W")])
def test_a_pull_on_the_hand_and_a_push_on_the_torso_are_felt_with_their_direction(
    into, leg_watchers, limb_watcher, scenario, limb
):
    course, _ = into(scenario, 1, {**leg_watchers, limb: limb_watcher(limb)})
    first = first_contact(course.force)
    assert first.start == pytest.approx(5000, abs=15)  # 3 s after the first 2 s, which are not kept
    reacted_at, reacted = course.reacted
    assert reacted.limb == limb
    assert first.start < reacted_at < first.stop
    force = course.force[first.start : reacted_at + 1].sum(axis=0)[:2]
    towards = reacted.direction @ force / np.linalg.norm(reacted.direction) / np.linalg.norm(force)
    assert np.degrees(np.arccos(towards)) < 30.0
    assert not course.point.any()  # no obstacle touches


def test_a_robot_whose_hand_is_held_back_steps_back_and_stands(into, limb_watcher):
    course, simulator = into("hand_held", 1, {"RA": limb_watcher("RA")})
    assert not course.fallen
    assert simulator.state.standing == 1


def test_a_plate_is_walked_over_as_the_ground_is(into, leg_watchers):
    course, _ = into("low_plate", 1, leg_watchers)
    assert not course.fallen
    assert course.reacted is None
    assert 900.0 < course.force[:, 2].max() < 1600.0  # it carries the robot, and no sole jams at its edge
    # Friction does not change its sign from step to step: that would be a force of 500 N to and fro.
    assert np.percentile(np.abs(np.diff(course.force[:, :2], axis=0)), 99.0) < 100.0
    first = first_contact(course.force)
    assert course.base[-1, 0] > course.base[first.start, 0] + 0.6
    assert np.abs(course.point[first, 2]).max() < 0.05


def test_the_place_of_the_base_and_the_error_of_its_velocity_are_told(hit, layout):
    course, _ = hit
    rows = course.rows[:, columns_of(layout)["q"]]
    assert rows[:, :3] == pytest.approx(course.base, abs=0.2)  # what is sensed drifts
    assert 0.0 < np.sqrt(np.square(course.error[2000:]).mean()) < 0.05


def test_the_force_of_an_obstacle_is_that_of_mujoco_s_contacts():
    """Sum of contact forces with the obstacle, by mj_contactForce, in the step in which they are largest."""
    simulator = Simulator(walk_settings(library_settings(), "foot_block", "ideal"), 1)
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
    simulator = Simulator(walk_settings(library_settings(), "foot_block", "ideal"), 1)
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


def test_a_reaction_tells_the_controller_the_direction_of_the_force():
    simulator = Simulator(walk_settings(library_settings(), "foot_block", "ideal"), 1)
    simulator.start()
    s = simulator.state
    assert (s.reacting, s.turns_back) == (0, 0)
    give_way(s, np.array([-0.6, 0.8]))
    assert (s.reacting, s.turns_back) == (1, 1)
    simulator.run(np.zeros((1, simulator.width), np.float32))
    assert (s.reacting, s.turns_back) == (1, 0)  # the foot turns back once
    assert s.away == pytest.approx([-0.6, 0.8])


class OneByOne:
    """Limb networks that step one by one, as an uncertainty model."""

    def __init__(self, networks, layout):
        where = signal_names(layout)
        self.networks = networks
        self.columns = [[where.index(name) for name in network.input_names] for network in networks]
        self.joints = tuple(joint for network in networks for joint in network.joints)

    def init(self):
        return [network.init() for network in self.networks]

    def step(self, state, sample):
        x, after, means, stds = signals(sample), [], [], []
        for network, carried, columns in zip(self.networks, state, self.columns, strict=True):
            stepped, found = network.step(carried, x[columns])
            after.append(stepped)
            means.append(found.mean)
            stds.append(found.std)
        return after, Prediction(np.concatenate(means), np.concatenate(stds))


def networks_of(layout, scale=1.0):
    """Return networks of base and legs with random weights, whose outputs are scaled."""
    networks = []
    for seed, limb in enumerate(("V", "LL", "RL")):
        inputs = limb_inputs(layout, Limb(joints=(limb,), Q=("LL", "RL"), T=("LL", "RL"))).names
        tensors, note = weights(NetworkCell(cell="GRU", hidden=50 + seed), len(inputs), 6, seed)
        tensors |= {name: scale * tensors[name] for name in ("target.mean", "target.std")}
        changes = {"inputs": inputs, "joints": layout.limb(limb)}
        networks.append(deployed(tensors, note.model_copy(update=changes)))
    return networks


def compliant(robot, settings, watchers, *steps):
    """Return a handler that steps along the force, with the configuration's numbers."""
    numbers = as_plain(settings.reaction, ReactionNumbers)
    return Handler(robot, numbers, settings.walking.foot_spacing_m, watchers, "compliant", *steps)


def test_a_walk_on_legs_alone_is_that_with_the_base_s_network_to_the_bit(robot, layout, leg_watchers, recipe_of):
    """Without force sensors the controller gets the feet's wrenches, which follow from the legs' torques alone."""
    settings = library_settings()
    base, *legs = networks_of(layout, scale=0.2)
    walked = []
    for networks in ([base, *legs], legs):
        simulator = Simulator(walk_settings(settings, "sensorless_walk", "sensor_noise"), 3)
        simulator.start()
        observer = recipe_of("MOB", "sensor_noise").observer()
        estimator = ResidualEstimator(observer, layout, LimbNetworks(networks, layout))
        handler = compliant(robot, settings, leg_watchers, 0, 2000)
        walked.append(walk_with(simulator, estimator, handler, 3000, 3000, 1.0, 0.03))
    whole, alone = walked
    assert len(whole.rows) > 2000
    assert whole.tau[:, :6].any()
    assert not alone.tau[:, :6].any()
    np.testing.assert_array_equal(alone.rows, whole.rows)
    np.testing.assert_array_equal(alone.tau[:, 6:], whole.tau[:, 6:])
    assert (alone.fallen, alone.reacted is None) == (whole.fallen, whole.reacted is None)


def test_networks_in_one_call_change_no_bit_of_a_walk(robot, layout, leg_watchers, recipe_of):
    settings = library_settings()
    networks = networks_of(layout)
    walked = []
    for model in (OneByOne(networks, layout), LimbNetworks(networks, layout)):
        simulator = Simulator(walk_settings(settings, "walk_test", "sensor_noise"), 3)
        simulator.start()
        estimator = ResidualEstimator(recipe_of("MOB", "sensor_noise").observer(), layout, model)
        handler = compliant(robot, settings, leg_watchers)
        walked.append(walk_with(simulator, estimator, handler, 1200, 1200, 1.0, 0.03))
    slow, fast = walked
    assert len(slow.rows) == 1200
    for name in ("rows", "tau", "std", "tracking"):
        np.testing.assert_array_equal(getattr(fast, name), getattr(slow, name))
