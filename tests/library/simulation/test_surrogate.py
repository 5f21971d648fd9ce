"""A surrogate robot: drawn from its seed, part by part, and seen by its sensors alone."""

import mujoco
import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from mobnet.robot.plant import robot_spec
from mobnet.settings.surrogate import SurrogateRobot
from mobnet.simulation.faults import perceive
from mobnet.simulation.surrogate import draw_hidden

RATE_HZ = 2000.0
WHOLE = ("drives", "body", "sensors")


@pytest.fixture
def draw(settings, robot):
    """A function of a seed and the hidden parts -> a surrogate robot."""

    def make(seed, *parts, day=0):
        chosen = SurrogateRobot.model_validate({"seed": seed, "parts": parts, "running_s": (0.0, 0.0), "day": day})
        return draw_hidden(robot, settings.plant, RATE_HZ, settings.surrogate, chosen, settings.seed)

    return make


def test_a_seed_is_a_robot(draw):
    """The same whenever it is drawn; another one differs in every part."""
    first, again, other = draw(1, *WHOLE), draw(1, *WHOLE), draw(2, *WHOLE)
    assert first.robot.bodies == again.robot.bodies
    assert (first.drives.law == again.drives.law).all()
    assert (first.faults.offset == again.faults.offset).all()
    assert all(one.mass != two.mass for one, two in zip(first.robot.bodies, other.robot.bodies, strict=True))
    assert not (first.drives.law == other.drives.law).any()
    assert (first.faults.gain != other.faults.gain).all()


def test_on_another_day_a_robot_has_other_errors_of_its_sensors_alone(draw):
    first, day, again, third = draw(1, *WHOLE), draw(1, *WHOLE, day=1), draw(1, *WHOLE, day=1), draw(1, *WHOLE, day=2)
    assert first.robot.bodies == day.robot.bodies
    assert first.plant == day.plant
    assert (first.drives.law == day.drives.law).all()
    assert (day.faults.zero == again.faults.zero).all()
    for other in (first, third):
        assert (day.faults.zero != other.faults.zero).all()
        assert (day.faults.gain != other.faults.gain).all()


def test_a_robot_may_have_other_numbers_and_keeps_all_others(settings):
    numbers = {"drive": {"dry_scale": 0.5}, "limbs": {"LL": {"stiffness_nm_rad": (1e4,) * 6}}}
    other = settings.surrogate.with_numbers(numbers)
    assert other.drive == settings.surrogate.drive.model_copy(update={"dry_scale": 0.5})
    assert other.limbs["LL"].stiffness_nm_rad == (1e4,) * 6
    assert other.limbs["LL"].coulomb_nm == settings.surrogate.limbs["LL"].coulomb_nm
    assert other.limbs["RL"] == settings.surrogate.limbs["RL"]
    assert other.sensors == settings.surrogate.sensors
    with pytest.raises(ValueError, match="dry_scal"):
        settings.surrogate.with_numbers({"drive": {"dry_scal": 0.5}})


def test_one_scale_multiplies_the_dry_friction_of_every_joint_alone(settings, robot):
    chosen = SurrogateRobot.model_validate({"seed": 1, "parts": ["drives"], "running_s": (0.0, 0.0)})
    drawn = []
    for scale in (1.0, 2.0):
        surrogate = settings.surrogate.with_numbers({"drive": {"dry_scale": scale}})
        drawn.append(draw_hidden(robot, settings.plant, RATE_HZ, surrogate, chosen, settings.seed).drives.law)
    one, two = drawn
    np.testing.assert_allclose(two["coulomb"], 2.0 * one["coulomb"])
    for name in set(one.dtype.names) - {"coulomb"}:
        np.testing.assert_array_equal(one[name], two[name])


@pytest.mark.parametrize("part", WHOLE)
def test_a_part_is_the_same_by_itself(draw, robot, settings, part):
    """So that a level can show what a part costs; the others are then those of the plant of section 5.1."""
    whole, single = draw(1, *WHOLE), draw(1, part)
    same = {
        "drives": (whole.drives.law["coulomb"] == single.drives.law["coulomb"]).all(),
        "body": [body.com for body in whole.robot.bodies] == [body.com for body in single.robot.bodies],
        "sensors": (whole.faults.zero == single.faults.zero).all(),
    }
    assert same == {name: name == part for name in WHOLE}
    if part != "body":
        assert single.robot.bodies == robot.bodies
        assert single.plant == settings.plant
    assert single.drives.hidden == (part == "drives")
    assert single.faults.hidden == (part == "sensors")


def test_numbers_lie_in_their_ranges(draw, robot, settings):
    """Every joint draws its own drive, every link its own mass and centre of mass."""
    hidden, ranges = draw(1, *WHOLE), settings.surrogate
    law = hidden.drives.law
    keys = {"constant": "torque_constant", "lag": "lag_s", "back": "back_ratio", "warm": "warm_share"}
    for name, key in keys.items():
        low, high = getattr(ranges.drive, key)
        assert low <= law[name].min() < law[name].max() <= high
        assert len(np.unique(law[name])) == len(law)
    for row, body in zip(robot.bodies, hidden.robot.bodies, strict=True):
        payload = ranges.body.payload_kg[1] if row.name == ranges.body.payload_body else 0.0
        assert abs(body.mass / row.mass - 1.0) <= ranges.body.mass_share + payload / row.mass
        assert np.abs(np.subtract(body.com, row.com)).max() <= ranges.body.com_m
    assert (law["rotor"] >= robot.armature).all()
    assert not hidden.robot.armature.any()


def test_a_payload_adds_to_the_one_that_is_drawn(settings, robot):
    chosen = SurrogateRobot.model_validate({"seed": 1, "parts": WHOLE, "running_s": (0.0, 0.0)})
    own, loaded = (
        draw_hidden(robot, settings.plant, RATE_HZ, settings.surrogate, one, settings.seed)
        for one in (chosen, chosen.model_copy(update={"payload_kg": 5.0}))
    )
    more = {two.name: two.mass - one.mass for one, two in zip(own.robot.bodies, loaded.robot.bodies, strict=True)}
    assert {name: kg for name, kg in more.items() if kg} == {settings.surrogate.body.payload_body: pytest.approx(5.0)}


def mass_matrix(robot):
    """Return the mass matrix (nv, nv) of a robot's plant where it starts."""
    model = robot_spec(robot).compile()
    data, matrix = mujoco.MjData(model), np.zeros((model.nv, model.nv))
    mujoco.mj_forward(model, data)
    mujoco.mj_fullM(model, data, matrix)
    return matrix


def test_the_mass_matrix_is_that_of_links_and_rotors(draw, robot, settings):
    """A rotor's inertia is in its drive and no longer in the joint, where it would count twice."""
    hidden, least = draw(1, "drives"), settings.surrogate.drive.rotor_min_kg_m2
    gone = mass_matrix(robot) - mass_matrix(hidden.robot)
    np.testing.assert_allclose(gone, np.diag([0.0] * 6 + [*robot.armature]), atol=1e-9)
    np.testing.assert_allclose(hidden.drives.law["rotor"], np.maximum(robot.armature, least))


def test_the_controller_and_the_observer_know_the_table_alone(simulate):
    """Nothing of a surrogate robot is in what they are built from."""
    known, other = (simulate("flat_place", level, standing=True) for level in ("robot_1", "robot_2"))
    for name in known.walker.tree._fields:
        np.testing.assert_array_equal(getattr(known.walker.tree, name), getattr(other.walker.tree, name))
    assert known.robot.bodies == other.robot.bodies


def seen(simulator):
    plant, faults = simulator.plant, simulator.hidden.faults
    perceive(
        faults, simulator.sensors, plant.drives, plant.qpos, plant.qvel, plant.sensordata, plant.xmat, plant.gravity
    )


def test_encoders_see_the_rotors(simulate):
    """With the error of their zeros."""
    simulator = simulate("flat_place", "robot_1", standing=True)
    drives, faults = simulator.hidden.drives, simulator.hidden.faults
    drives.state["angle"] += 0.01
    drives.state["rate"] = 0.5
    seen(simulator)
    np.testing.assert_allclose(faults.qpos[7:], drives.state["angle"] + faults.zero, rtol=1e-12)
    np.testing.assert_array_equal(faults.qvel[6:], 0.5)


def test_inertial_readings_are_late_and_biased(simulate):
    simulator = simulate("flat_place", "robot_1", standing=True)
    faults, plant, acc = simulator.hidden.faults, simulator.plant, simulator.sensors.acc
    faults.steps[0] = 0
    found = []
    for k in range(3 * faults.late):
        plant.sensordata[acc : acc + 3] = 1 + k
        seen(simulator)
        found.append(faults.data[acc : acc + 3] - faults.acc)
    wanted = 1 + np.maximum(np.arange(3 * faults.late) - faults.late, 0)  # at first nothing but the first reading
    np.testing.assert_allclose(np.array(found), wanted[:, None] * np.ones(3), atol=1e-12)


@pytest.mark.parametrize("tilt_rad", [0.0, 0.4])
def test_a_foot_at_rest_in_the_air_reads_what_its_calibration_left(simulate, tilt_rad):
    """The error of the calibrated mass, times gravity, times the gain, plus the constant error; tilted or not."""
    simulator = simulate("flat_place", "robot_1", standing=True)
    faults, plant, sensors = simulator.hidden.faults, simulator.plant, simulator.sensors
    foot_to_world = Rotation.from_rotvec(tilt_rad * np.array([0.6, 0.8, 0.0])).as_matrix()
    upwards = foot_to_world[2]  # in the foot's axes
    plant.sensordata[:] = 0.0
    for k in range(2):
        plant.xmat[faults.soles[k]] = foot_to_world.ravel()
        plant.sensordata[faults.foot_acc[k] : faults.foot_acc[k] + 3] = plant.gravity * upwards
    seen(simulator)
    true, known = faults.plate
    weight = -(true - known) * plant.gravity * upwards
    moment = np.cross(faults.arm, weight)
    for k in range(2):
        wrench = -faults.data[[*range(sensors.force[k], sensors.force[k] + 3),
                               *range(sensors.torque[k], sensors.torque[k] + 3)]]  # fmt: skip
        expected = faults.gain[k] * np.concatenate([weight, moment]) + faults.offset[k]
        np.testing.assert_allclose(wrench, expected, rtol=1e-9, atol=1e-12)


def test_the_gears_go_on_running(simulate):
    """From one episode to the next, from a time that is drawn for the recording."""
    simulator = simulate("flat_place", "robot_1")
    low, high = simulator.settings.level.surrogate.running_s
    assert low <= simulator.running_s <= high
    simulator.start(100.0)
    assert simulator.hidden.drives.clock[0] == simulator.running_s + 100.0
    simulator.run(np.zeros((200, simulator.width), dtype=np.float32))
    assert simulator.hidden.drives.clock[0] == pytest.approx(simulator.running_s + 100.2, abs=1e-6)
