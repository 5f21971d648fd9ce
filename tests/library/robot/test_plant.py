"""The plant: order of its velocity, nothing to spare, foot sensors that read minus the ground's wrench."""

import mujoco
import numpy as np
import pytest

from mobnet.robot.description import SIDES
from mobnet.robot.plant import SOLE_TYPE, TERRAIN_TYPE, sole_name


def test_velocity_and_motors_stand_in_layout_order(plant, robot):
    hinges = [plant.joint(i).name for i in range(plant.njnt) if plant.jnt_type[i] == mujoco.mjtJoint.mjJNT_HINGE]
    assert tuple(hinges) == robot.layout.actuated
    assert tuple(plant.actuator(i).name for i in range(plant.nu)) == robot.layout.actuated
    np.testing.assert_array_equal(plant.actuator_trnid[:, 0], [plant.joint(name).id for name in robot.layout.actuated])
    np.testing.assert_array_equal(plant.jnt_dofadr[1:], np.arange(6, plant.nv))
    assert (plant.nq, plant.nv) == (robot.layout.nq, robot.layout.nv)


def test_motor_torque_arrives_unchanged_and_unclipped(plant):
    data = mujoco.MjData(plant)
    data.ctrl[:] = np.arange(plant.nu) * 1e3
    mujoco.mj_forward(plant, data)
    np.testing.assert_array_equal(data.qfrc_actuator[6:], data.ctrl)
    np.testing.assert_array_equal(data.qfrc_actuator[:6], 0)


def test_joints_have_rotors_alone_and_the_weight_is_the_table_s(plant, robot):
    np.testing.assert_array_equal(plant.dof_armature[6:], robot.armature)
    for figure in (plant.dof_damping, plant.dof_frictionloss, plant.jnt_stiffness):
        assert not figure.any()
    assert plant.body_mass.sum() == pytest.approx(robot.mass, rel=1e-12)
    assert all(plant.body(sole_name(side)).mass == 0 for side in SIDES)


def test_only_soles_collide_and_only_with_terrain(plant):
    soles = {plant.geom(sole_name(side)).id for side in SIDES}
    for geom in range(plant.ngeom):
        kind = (plant.geom_contype[geom], plant.geom_conaffinity[geom])
        assert kind == ((SOLE_TYPE, TERRAIN_TYPE) if geom in soles else (0, 0))
    assert not SOLE_TYPE & TERRAIN_TYPE


def test_stands_as_tall_as_the_robot(plant, robot):
    data = mujoco.MjData(plant)
    mujoco.mj_forward(plant, data)
    head, sole = plant.geom("head"), data.body(sole_name("left")).xpos[2] + robot.sole.height
    top = data.geom("head").xpos[2] + head.size[2]
    assert top - sole == pytest.approx(1.8, abs=0.05)


def test_imu_reads_specific_force_and_turning_rate_in_the_base(plant):
    data = mujoco.MjData(plant)
    data.qpos[3:7] = np.array([np.cos(0.3), np.sin(0.3), 0, 0])
    data.qvel[3:6] = [0.1, 0.2, 0.3]
    mujoco.mj_forward(plant, data)
    np.testing.assert_allclose(data.sensor("imu_gyro").data, [0.1, 0.2, 0.3], atol=1e-12)
    data.qvel[:] = 0
    mujoco.mj_forward(plant, data)
    np.testing.assert_allclose(data.sensor("imu_acc").data, 0, atol=1e-9)  # free fall
