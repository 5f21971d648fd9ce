"""The tables of configs/robots that are made from files of others: equal to MuJoCo's own reading of these files.

`tests/data/NAME.npz` has that reading, made by `tests/data/readings.py` from the URDF that the head of the table names;
neither the package with the URDF nor the import is needed here.
"""

from dataclasses import replace
from pathlib import Path

import mujoco
import numpy as np
import pytest

from mobnet.core.errors import ConfigError
from mobnet.formats.loading import load_section
from mobnet.formats.robot import RobotTable
from mobnet.robot.description import SIDES, describe, for_walking
from mobnet.robot.dynamics import bias, mass_matrix
from mobnet.robot.nominal import NominalModel
from mobnet.robot.plant import robot_spec, sole_name
from mobnet.robot.wrench import feet_torque

ROOT = Path(__file__).parents[3]
EQUAL = 1e-10  # of the largest entry
NAMES = ("panda", "g1")
WRENCH = np.array([10.0, -20.0, 300.0, 4.0, -5.0, 6.0])  # [N], [N m]


@pytest.fixture
def read(imported):
    """MuJoCo's own reading of the file that a table was made from."""
    return np.load(ROOT / "tests" / "data" / f"{imported.name.lower()}.npz")


def test_mass_matrix_and_bias_are_those_of_the_original(imported, read):
    """Of both models, Pinocchio's and MuJoCo's; rotors, which no URDF has, are in the table alone."""
    robot = imported
    assert [joint.name for joint in robot.joints] == read["joints"].tolist()
    rotors = np.diag(np.r_[np.zeros(len(robot.layout.virtual)), robot.armature])
    nominal, plant = NominalModel(robot), robot_spec(robot).compile()
    data, inertia = mujoco.MjData(plant), np.zeros((plant.nv, plant.nv))
    for q, v, lower, terms in zip(read["q"], read["v"], read["inertia"], read["bias"], strict=True):
        expected = np.zeros_like(inertia)
        expected[np.tril_indices(plant.nv)] = lower
        expected += np.tril(expected, -1).T + rotors
        data.qpos[:], data.qvel[:] = q, v
        mujoco.mj_forward(plant, data)
        mujoco.mj_fullM(plant, data, inertia)
        for found in (mass_matrix(nominal, q), inertia):
            np.testing.assert_allclose(found, expected, rtol=0, atol=EQUAL * np.abs(expected).max())
        for found in (bias(nominal, q, v), data.qfrc_bias):
            np.testing.assert_allclose(found, terms, rtol=0, atol=EQUAL * np.abs(terms).max())


def test_a_mass_that_is_one_part_in_a_million_off_is_seen(imported, read):
    """The comparison above could fail."""
    robot = imported
    other = robot.bodies[-1].model_copy(update={"mass": robot.bodies[-1].mass * (1 + 1e-6)})
    off = NominalModel(replace(robot, bodies=(*robot.bodies[:-1], other)))
    q, v, terms = read["q"][0], read["v"][0], read["bias"][0]
    assert np.abs(bias(off, q, v) - terms).max() > EQUAL * np.abs(terms).max()


@pytest.mark.parametrize(
    ("name", "lacks"),
    [
        ("panda", ("a floating base", "feet on both sides", "an inertial sensor (`imu`)")),
        ("g1", ("axes z, x, y, y, y, x (here y, x, z, y, y, x)", "leg geometry (`leg`)")),
    ],
)
def test_why_a_robot_does_not_walk_is_one_line(name, lacks):
    robot = describe(load_section(ROOT / "configs" / "robots" / f"{name}.yaml", RobotTable))
    with pytest.raises(ConfigError) as told:
        for_walking(robot)
    assert "\n" not in str(told.value)
    assert all(part in str(told.value) for part in lacks)


def test_limbs_and_networks_cover_every_motor_once(imported):
    limbs = [joint for limb, joints in imported.layout.groups.items() if limb != "V" for joint in joints]
    assert sorted(limbs) == sorted(imported.layout.actuated)


@pytest.mark.parametrize("side", SIDES)
def test_feet_of_the_second_humanoid_give_labels_for_its_legs(side):
    """J^T F of a foot's sensor is what MuJoCo makes of it, and loads that leg and the base alone."""
    robot = describe(load_section(ROOT / "configs" / "robots" / "g1.yaml", RobotTable))
    plant, q = robot_spec(robot).compile(), np.load(ROOT / "tests" / "data" / "g1.npz")["q"][0]
    data, expected = mujoco.MjData(plant), np.zeros(plant.nv)
    data.qpos[:] = q
    mujoco.mj_forward(plant, data)
    site = data.site(sole_name(side))
    force, moment = (site.xmat.reshape(3, 3) @ part for part in (WRENCH[:3], WRENCH[3:]))
    mujoco.mj_applyFT(plant, data, force, moment, site.xpos, plant.body(sole_name(side)).id, expected)
    found = feet_torque(NominalModel(robot), q, {side: WRENCH})
    np.testing.assert_allclose(found, expected, atol=1e-9)
    loaded = {name for name, torque in zip(robot.layout.names, found, strict=True) if torque}
    assert loaded == {*robot.layout.virtual, *robot.layout.limb(robot.feet[side].limb)}


@pytest.mark.parametrize("name", NAMES)
def test_networks_see_no_torque_and_predict_each_joint_once(name):
    table = load_section(ROOT / "configs" / "robots" / f"{name}.yaml", RobotTable)
    predicted = [limb for network in table.networks.values() for limb in network.joints]
    assert sorted(predicted) == sorted(limb for limb in table.groups if limb != "V")
    assert not any(network.T for network in table.networks.values())
