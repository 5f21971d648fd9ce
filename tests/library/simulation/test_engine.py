"""The plant's loop: external torque, sensors, symmetries, limits."""

import copy

import mujoco
import numpy as np
import pytest

from mobnet.control.walking import walk
from mobnet.robot.description import SIDES
from mobnet.robot.plant import sole_name
from mobnet.simulation import engine

NV = 39


def contact_torque(simulator):
    """Return the sum of J^T F (nv,) over the contacts of the step just taken, by MuJoCo's own functions."""
    model, data = simulator.world.model, simulator.world.data
    torque, wrench, jacobian = np.zeros(NV), np.zeros(6), np.zeros((3, NV))
    for index, contact in enumerate(data.contact):
        mujoco.mj_contactForce(model, data, index, wrench)
        force = contact.frame.reshape(3, 3).T @ wrench[:3]
        for geom, sign in ((contact.geom1, -1), (contact.geom2, 1)):
            mujoco.mj_jac(model, data, jacobian, None, contact.pos, model.geom_bodyid[geom])
            torque += sign * jacobian.T @ force
    return torque


def external(simulator):
    """Return the loop's torque of contacts and of pushes (nv,) and ground's force on each foot (2,) [N], one step's."""
    contacts, pushes, touch = np.zeros(NV), np.zeros(NV), np.zeros(2)
    engine._add_contacts(simulator.plant, simulator.walker, contacts, touch)
    engine._add_pushes(simulator.plant, pushes)
    return contacts, pushes, touch


def normal_forces(simulator):
    """Return the sum of the normal forces (2,) [N] of each foot's contacts, by mj_contactForce."""
    model, data, wrench, forces = simulator.world.model, simulator.world.data, np.zeros(6), np.zeros(2)
    soles = [model.geom(sole_name(side)).id for side in SIDES]
    for index, contact in enumerate(data.contact):
        mujoco.mj_contactForce(model, data, index, wrench)
        forces[[sole in (contact.geom1, contact.geom2) for sole in soles].index(True)] += wrench[0]
    return forces


def assert_near(found, expected, share):
    """Check that torques or forces are as expected, up to a share of the largest one."""
    np.testing.assert_allclose(found, expected, atol=share * max(1.0, np.abs(expected).max()))


def pushed_torque(simulator):
    """Return what the wrenches on bodies of the step just taken do (nv,), by mj_jac at their centres of mass."""
    model, data, torque = simulator.world.model, simulator.world.data, np.zeros(NV)
    linear, angular = np.zeros((3, NV)), np.zeros((3, NV))
    for body in np.flatnonzero(data.xfrc_applied.any(axis=1)):
        mujoco.mj_jac(model, data, linear, angular, data.xipos[body], body)
        torque += linear.T @ data.xfrc_applied[body, :3] + angular.T @ data.xfrc_applied[body, 3:]
    return torque


def sole_torque(simulator):
    """Return the foot sensors' wrenches mapped through their Jacobian (nv,)."""
    model, data, mapped = simulator.world.model, simulator.world.data, np.zeros(NV)
    linear, angular = np.zeros((3, NV)), np.zeros((3, NV))
    for k, side in enumerate(SIDES):
        site = model.site(sole_name(side)).id
        mujoco.mj_jacSite(model, data, linear, angular, site)
        axes = data.site_xmat[site].reshape(3, 3)
        wrench = simulator.sensors.wrenches[k]
        mapped += linear.T @ axes @ wrench[:3] + angular.T @ axes @ wrench[3:]
    return mapped


@pytest.fixture
def pushed_walk(simulate):
    """A function (terrain, pushes) -> a random walk with random torque on a terrain, pushed again and again."""
    law = {"pause_s": [0.01, 0.1], "force_n": [20.0, 60.0], "duration_s": [0.05, 0.2], "shape": "half_sine"}
    law["moment_nm"] = [1.0, 5.0]
    points = {"left": "left_sole", "right": "right_sole", "torso": "torso", "hand": "right_hand"}
    laws = {name: {**law, "point": point, "direction": "any"} for name, point in points.items()}

    def make(terrain, pushes=tuple(points), level="all_uncertainty"):
        row = {"terrain": [terrain], "commands": "random", "random_torque": True, "pushes": list(pushes)}
        return simulate("pushed_walk", level, pushes=laws, scenarios={"pushed_walk": row})

    return make


@pytest.mark.parametrize("level", ["ideal", "all_uncertainty"])
@pytest.mark.parametrize("terrain", ["checks", "plates", "slope", "flat"])
def test_contacts_and_pushes_are_the_external_torque_and_touch_is_ground_alone(pushed_walk, run, terrain, level):
    """The reference is MuJoCo's contact forces and the wrenches on bodies, through mj_jac (equation (2)).

    A pushed foot in the air touches nothing.
    """
    simulator, pushed, seen = pushed_walk(terrain, level=level), 0, set()
    for _ in range(60):
        run(simulator, 0.023)
        contact, push = contact_torque(simulator), pushed_torque(simulator)
        contacts, pushes, touch = external(simulator)
        assert_near(contacts, contact, 1e-9)
        assert_near(pushes, push, 1e-9)
        assert_near(touch, normal_forces(simulator), 1e-9)
        pushed += np.abs(push).max() > 5
        seen.add(tuple(touch > engine.CONTACT_FORCE_N))
    assert pushed > 40
    assert seen == {(True, False), (False, True), (True, True)}


@pytest.mark.parametrize("terrain", ["checks", "plates", "slope", "flat"])
def test_foot_sensors_feel_contacts_and_pushes_on_the_foot(pushed_walk, run, terrain):
    """Mapped through their Jacobian the foot wrenches are J^T F of contacts and of pushes on the massless soles."""
    for pushes, felt in ((("left", "right"), True), (("torso", "hand"), False)):
        simulator = pushed_walk(terrain, pushes, "no_noise")
        for _ in range(30):
            run(simulator, 0.023)
            expected = contact_torque(simulator) + felt * pushed_torque(simulator)
            assert_near(sole_torque(simulator), expected, 1e-8)


@pytest.mark.sim
@pytest.mark.parametrize("scenario", ["flat_place", "checks_place"])
def test_standing_robot_stays_upright_and_weighs_its_weight(simulate, run, scenario):
    simulator = simulate(scenario, "ideal", standing=True)
    log = run(simulator, 5.0)
    assert log.done == 5000
    end = log.rows[-500:]
    weight = simulator.robot.mass * 9.81
    assert end[:, log.columns["tau_ext"]][:, 2].mean() == pytest.approx(weight, rel=1e-3)
    w, x, y, _ = end[:, log.columns["q"]][:, 3:7].T
    assert np.abs(2 * (w * y - x * y)).max() < 0.05
    assert np.abs(end[:, log.columns["v"]]).max() < 0.02
    assert log["contact"][-500:].all()
    assert not log["swing"].any()


@pytest.mark.sim
@pytest.mark.parametrize("yaw", [np.pi / 2, np.pi])
def test_turned_start_gives_the_turned_motion(simulate, run, turned, yaw):
    """By right angles, under which the friction pyramid is invariant."""
    here, there = simulate("flat_walk", "ideal"), simulate("flat_walk", "ideal")
    start = turned(here.plant.qpos, here.plant.qvel, here.state, yaw, np.zeros(2))
    put(there, *start)
    for simulator in (here, there):
        assert run(simulator, 2.0).done == 2000
    q, v, _ = turned(here.plant.qpos, here.plant.qvel, here.state, yaw, np.zeros(2))
    np.testing.assert_allclose(there.plant.qpos[7:], q[7:], atol=1e-4)
    np.testing.assert_allclose(np.remainder(there.plant.qpos[:2] - q[:2] + 0.5, 1.0) - 0.5, 0, atol=1e-4)
    np.testing.assert_allclose(there.plant.qvel, v, atol=1e-3)


@pytest.mark.sim
def test_mirrored_start_gives_the_mirrored_motion(simulate, run, mirrored):
    """Within what the table's own small asymmetry does in a second."""
    here, there = simulate("flat_walk", "ideal"), simulate("flat_walk", "ideal")
    put(there, *mirrored(here.plant.qpos, here.plant.qvel, here.state))
    there.commands = there.commands * [1, -1, -1, 1, 1]
    for simulator in (here, there):
        assert run(simulator, 1.0).done == 1000
    q, _, s = mirrored(here.plant.qpos, here.plant.qvel, here.state)
    np.testing.assert_allclose(there.plant.qpos, q, atol=1e-3)
    assert (there.state.side, there.state.steps) == (s.side, s.steps)


def put(simulator, q, v, s):
    simulator.plant.qpos[:] = simulator.sensors.q[:] = q
    simulator.plant.qvel[:] = simulator.sensors.v[:] = v
    simulator.state = s


def test_wrap_over_a_period_keeps_torques(simulate, run):
    """The controller is invariant to a shift by a period."""
    simulator = simulate("flat_walk", "all_uncertainty")
    run(simulator, 1.0)
    plant, sensors, s = simulator.plant, simulator.sensors, simulator.state
    wrapped, moved = s.copy(), plant._replace(period=1e-6, edge=1e-6, qpos=plant.qpos.copy())
    shifted = sensors._replace(q=sensors.q.copy())
    engine._wrap(moved, shifted, wrapped)
    assert (np.abs(moved.qpos[:2] - plant.qpos[:2]) > 0).all()
    torques = []
    for state, q in ((s.copy(), sensors.q), (wrapped, shifted.q)):
        tau = np.zeros(33)
        walk(simulator.walker, state, q, sensors.v, sensors.wrenches, simulator.commands, plant.dt, tau)
        torques.append(tau)
    np.testing.assert_allclose(torques[0], torques[1], atol=1e-9)


@pytest.mark.sim
def test_robot_never_leaves_the_terrain(simulate, run):
    simulator = simulate("forward_walk", "all_uncertainty")
    log = run(simulator, 14.0)
    step = np.abs(np.diff(log["q"][:, :2], axis=0))
    assert np.abs(log["q"][:, :2]).max() < simulator.plant.edge + 0.05
    assert ((step < 0.01) | (np.abs(step - simulator.plant.period) < 0.01)).all()
    assert (step > 0.01).any()  # it walked further than a period


def tick(simulator, run, torque):
    """Return what a tick from here would log under an exploration (nu,) [N m], and go back to where it began."""
    model, data, sensors = simulator.world.model, simulator.world.data, simulator.sensors
    kept = copy.copy(data), simulator.state.copy(), simulator.rng["noise"].bit_generator.state
    arrays = [value for value in sensors if isinstance(value, np.ndarray)]
    values = [value.copy() for value in arrays]
    simulator.torque.value[:] = torque
    log = run(simulator, 0.001)
    mujoco.mj_copyData(data, model, kept[0])
    simulator.state, simulator.rng["noise"].bit_generator.state = kept[1:]
    for array, value in zip(arrays, values, strict=True):
        array[:] = value
    return log


@pytest.mark.sim
def test_random_torque_is_part_of_the_desired_torque_but_not_on_support(simulate, run):
    """The reference is the same tick without it; section 4.3: never on the support leg, here 0 samples."""
    simulator, added, phases = simulate("random_walk_plain", "all_uncertainty"), np.linspace(4.0, 8.0, 33), set()
    simulator.torque.left[:] = np.inf  # nothing new is drawn
    each, once = simulator.plant, simulator.plant._replace(every=1)
    half_weight = simulator.robot.mass * 9.81 / 2
    for _ in range(250):
        simulator.plant, simulator.torque.value[:] = each, 0.0
        run(simulator, 0.012)
        simulator.plant = once
        quiet, moved = tick(simulator, run, np.zeros(33)), tick(simulator, run, added)
        expected = added.copy()
        for k, foot in enumerate(("left", "right")):
            carries = not moved["swing"][0, k]
            assert carries or moved[f"wrench_{foot}_foot"][0, 2] < half_weight
            expected[6 * k : 6 * k + 6] *= not carries
        np.testing.assert_allclose(moved["tau_des"][0] - quiet["tau_des"][0], expected, atol=2e-4)
        np.testing.assert_array_equal(moved["tau_random"][0], expected.astype(np.float32))
        assert not quiet["tau_random"].any()
        phases.add(tuple(moved["swing"][0]))
    assert phases == {(0, 0), (0, 1), (1, 0)}


@pytest.mark.sim
def test_a_foot_has_the_time_that_is_left_and_none_once_it_is_late(simulate, run):
    simulator = simulate("flat_place", "ideal")
    state = simulator.state
    while not (state.swinging and state.t > 0.5 * state.total):
        log = run(simulator, 0.01)
    side = int(np.flatnonzero(log["swing"][-1])[0])
    assert log["landing"][-1, side] == pytest.approx(state.total - state.t, abs=1e-3)
    assert log["landing"][-1, 1 - side] == 0.0
    state.total = state.t
    late = run(simulator, 0.02)
    assert late["swing"][:, side].all()
    np.testing.assert_array_equal(late["landing"], 0.0)


@pytest.mark.sim
def test_no_drive_is_asked_for_more_than_it_gives(simulate, run):
    """Random torque that is far beyond the limits is clipped before it is sent and logged."""
    simulator = simulate("random_walk", "all_uncertainty")
    simulator.torque.amplitude[:] = 1000.0
    log = run(simulator, 1.0)
    limits = simulator.plant.limits * (1 + 1e-6)
    assert (np.abs(log["tau_des"]) <= limits).all()
    assert (np.abs(log["tau_des"]) > 0.99 * limits).any(axis=0)[12:].all()  # legs are reached in swing only
    np.testing.assert_array_equal(log["tau_des"], log["tau_motor"])


def test_joint_limits_are_no_external_torque(simulate, run):
    """A robot in the air whose elbow is driven against the end of its range has no external torque."""
    simulator = simulate("flat_place", "ideal", standing=True)
    simulator.plant.qpos[2] += 3.0
    joint = simulator.world.model.joint("LA5")
    simulator.plant.qpos[joint.qposadr[0]] = joint.range[0] - 0.01
    simulator.plant.ctrl[:] = 0.0
    mujoco.mj_step(simulator.world.model, simulator.world.data)
    data = simulator.world.data
    limits = data.efc_type == mujoco.mjtConstraint.mjCNSTR_LIMIT_JOINT
    assert data.efc_force[limits].sum() > 1.0
    assert not external(simulator)[0].any()


@pytest.mark.sim
@pytest.mark.parametrize("scenario", ["forward_walk", "random_walk"])
def test_walking_touches_no_joint_limit(simulate, run, scenario):
    simulator = simulate(scenario, "all_uncertainty")
    log = run(simulator, 8.0)
    low, high = np.array([joint.range for joint in simulator.robot.joints]).T
    joints = log["q"][: log.done, 7:]
    assert (joints > low + 0.05).all()
    assert (joints < high - 0.05).all()


def test_run_stops_at_a_fall(simulate, run, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)  # MuJoCo notes there that a number is not finite
    low = simulate("flat_walk", "ideal")
    low.plant.qpos[2] = 0.3
    assert run(low, 0.1).done == 0
    lost = simulate("flat_walk", "ideal")
    lost.sensors.v[10] = np.nan
    assert run(lost, 0.1).done < 100
