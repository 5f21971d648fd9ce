"""The compiled plant is the one that the configuration asks for."""

import mujoco
import numpy as np
import pytest

from mobnet.reaction.loop import columns_of
from mobnet.simulation.simulator import Simulator
from mobnet.simulation.terrain import TERRAIN_GROUP, draw_terrain
from mobnet.simulation.world import ground_height, make_world


@pytest.fixture
def build(settings, robot):
    """A function (terrain, level, seed) -> a world."""

    def make(terrain, level="ideal", seed=0):
        drawn = draw_terrain(dict(settings.terrain)[terrain], np.random.default_rng(seed))
        return make_world(robot, drawn, settings.plant, settings.levels[level], settings.rates.plant_hz)

    return make


def test_options_are_those_the_truth_is_aligned_with(build):
    option = build("checks").model.opt
    assert option.timestep == 0.0005
    assert option.integrator == mujoco.mjtIntegrator.mjINT_EULER
    assert option.jacobian == mujoco.mjtJacobian.mjJAC_SPARSE  # the truth reads sparse contact rows
    assert option.noslip_iterations == 0
    np.testing.assert_array_equal(option.gravity, [0, 0, -9.81])


@pytest.mark.parametrize(("level", "present"), [("ideal", 0), ("sensor_noise", 0), ("all_uncertainty", 1)])
def test_level_switches_friction_loss(build, level, present):
    model = build("flat", level).model
    np.testing.assert_array_equal(model.dof_frictionloss[:6], 0)
    np.testing.assert_array_equal(model.dof_frictionloss[6:], present * np.where(np.arange(33) < 12, 10.0, 8.0))
    assert not model.dof_damping.any()


def test_every_contact_is_the_configured_one(build, settings):
    model = build("checks").model
    pieces = np.flatnonzero((model.geom_bodyid == 0) & (model.geom_group == TERRAIN_GROUP))
    soles = {model.geom(f"{side}_sole").id for side in ("left", "right")}
    paired = {tuple(sorted(pair)) for pair in zip(model.pair_geom1.tolist(), model.pair_geom2.tolist(), strict=True)}
    assert paired == {tuple(sorted((piece, sole))) for piece in pieces.tolist() for sole in soles}
    assert set(model.pair_friction[:, :2].ravel()) == {settings.plant.contact_friction}
    assert len(np.unique(model.pair_solref, axis=0)) == 1
    assert model.opt.impratio == settings.plant.contact_grip


@pytest.mark.parametrize("gravity", [5.0, 9.81, 15.0])
def test_a_sole_is_as_stiff_as_configured(simulate, run, gravity):
    """A loading test: a robot that stands on two flat soles sinks by its load over their stiffness."""
    simulator = simulate("flat_place", "ideal", standing=True, plant={"gravity_m_s2": gravity})
    run(simulator, 4.0)
    data, plant = simulator.world.data, simulator.settings.plant
    assert data.ncon == 8
    sinks = -np.mean([contact.dist for contact in data.contact])
    assert simulator.robot.mass * gravity / 2 / sinks == pytest.approx(plant.sole_stiffness_n_m, rel=0.01)


def test_a_sole_is_as_damped_as_configured(simulate, run):
    """A robot that sinks at a speed meets damping times speed more; what a contact has of a mass takes a little."""
    simulator = simulate("flat_place", "ideal", standing=True)
    run(simulator, 2.0)
    forces = []
    for speed in (0.0, 0.05):
        simulator.world.data.qvel[:] = 0.0
        simulator.world.data.qvel[2] = -speed
        mujoco.mj_forward(simulator.world.model, simulator.world.data)
        forces.append(vertical_force(simulator.world) / 2)
    damping = simulator.settings.plant.sole_damping_ns_m
    assert (forces[1] - forces[0]) / 0.05 == pytest.approx(damping, rel=0.1)


def test_a_sole_that_carries_hardly_creeps(simulate, run):
    """A standing robot that is pulled sideways by 30 N moves its soles by less than a millimetre in a second."""
    simulator = simulate("flat_place", "ideal", standing=True)
    run(simulator, 3.0)
    data = simulator.world.data
    before = data.geom("left_sole").xpos.copy()
    simulator.plant.xfrc_applied[1, 1] = 30.0
    run(simulator, 1.0)
    assert np.abs(data.geom("left_sole").xpos - before)[:2].max() < 0.001


@pytest.mark.sim
def test_friction_of_a_sole_keeps_its_sign_from_step_to_step(walk_of):
    """What a robot's soles feel along the ground changes by little in a step: its gears leave a foot light."""
    walk = walk_of("flat_walk", "robot_1", rates={"data_hz": 2000.0})
    simulator = Simulator(walk, 1)
    simulator.start()
    rows = np.zeros((int(2.0 * walk.rates.plant_hz), simulator.width), dtype=np.float32)
    assert simulator.run(rows) == len(rows)
    force = rows[:, columns_of(simulator.robot.layout)["tau_ext"]][len(rows) // 2 :, :2]
    assert np.abs(force).mean() > 5.0
    assert np.abs(np.diff(force, axis=0)).mean() < 5.0  # 700 N and more where friction overshoots


def vertical_force(world):
    total, wrench = 0.0, np.zeros(6)
    for index in range(world.data.ncon):
        mujoco.mj_contactForce(world.model, world.data, index, wrench)
        total += wrench[0]
    return total


@pytest.fixture
def turn_hand(build):
    """A function (law of speed [rad/s] -> torque [N m], ticks) -> speed of the hand of a robot that floats, at last."""
    world = build("flat", "all_uncertainty")
    model, data = world.model, world.data
    model.opt.gravity[:], data.qpos[2] = 0.0, 3.0
    motor, speed = model.actuator("LA8").id, model.jnt_dofadr[model.joint("LA8").id]

    def turn(law, ticks):
        for _ in range(ticks):
            data.ctrl[motor] = law(data.qvel[speed])
            mujoco.mj_step(model, data)
        return data.qvel[speed]

    return turn


def test_friction_loss_holds_a_light_joint_and_takes_its_whole_torque_of_a_slow_one(turn_hand):
    """MuJoCo's default lets the hand's joint turn at 0.5 rad/s below a loss of 8 N m (Table 4).

    A drive of 10 N m s towards 0.9 rad/s then turns it at 0.1 rad/s; with MuJoCo's default at 0.4 rad/s.
    """
    for torque in (7.5, -7.5):
        assert abs(turn_hand(lambda _, torque=torque: torque, 2000)) < 0.01
    assert turn_hand(lambda speed: 10.0 * (0.9 - speed), 200) == pytest.approx(0.1, abs=0.005)


def test_joints_stop_at_their_ranges(build, robot):
    """Every joint, driven by its whole motor, ends within two degrees of the end of its range, free of gravity."""
    for sign in (-1.0, 1.0):
        world = build("flat")
        model, data = world.model, world.data
        assert model.jnt_limited[1:].all()
        np.testing.assert_allclose(model.jnt_range[1:], [joint.range for joint in robot.joints])
        for joint in robot.joints:
            end = joint.range[int(sign > 0)]
            mujoco.mj_resetData(model, data)
            model.opt.gravity[:] = 0.0
            data.qpos[2] = 5.0
            address = model.joint(joint.id).qposadr[0]
            data.qpos[address] = end - sign * 0.05
            data.ctrl[model.actuator(joint.id).id] = sign * min(joint.torque_limit, 30.0)
            for _ in range(400):
                mujoco.mj_step(model, data)
            assert sign * (data.qpos[address] - end) < np.deg2rad(2.0), joint.id


def test_plant_keeps_the_true_masses_at_every_level(build, settings, robot):
    for level in settings.levels:
        mass = build("flat", level).model.body_mass.sum()
        assert mass == pytest.approx(robot.mass, rel=1e-12)


@pytest.mark.parametrize("name", ["checks", "flat", "plates", "slope"])
def test_rays_find_the_heights_of_what_stands_there(build, name):
    """The pieces' own figures tell the height without a ray; the robot is no ground, also after a reset."""
    world = build(name, seed=3)
    points = np.random.default_rng(4).uniform(-0.5, 0.5, (500, 2)) * world.period
    found = ground_height(world, points)
    np.testing.assert_allclose(found, heights_of_pieces(world, points), atol=1e-6)
    mujoco.mj_resetData(world.model, world.data)
    np.testing.assert_array_equal(ground_height(world, points), found)


def heights_of_pieces(world, points):
    """Return the height (n,) [m] of the highest piece under points (n, 2) [m], from the pieces' widths."""
    highest = np.zeros(len(points))
    for piece in world.terrain.pieces:
        c, n = np.cos(piece.yaw), np.sin(piece.yaw)
        for i, j in np.ndindex(3, 3):
            offset = points - piece.place - world.period * (np.array([i, j]) - 1)
            inside = np.abs(offset @ [[c, -n], [n, c]])
            ended = np.isfinite(piece.bottom)
            bottom, top = piece.bottom[ended], piece.top[ended]
            slope = (bottom - inside[:, ended]) / (bottom - top)
            highest = np.maximum(highest, piece.height * np.clip(slope.min(axis=1), 0.0, 1.0))
    return highest
