"""The nominal model: the plant's twin at ratio 1, a lighter one below, and roots that would not do."""

import mujoco
import numpy as np
import pinocchio as pin
import pytest

from mobnet.robot.dynamics import bias, gravity, mass_matrix
from mobnet.robot.frames import to_pinocchio
from mobnet.robot.nominal import NominalModel


def test_velocities_stand_in_layout_order(nominal, robot):
    assert (nominal.model.nq, nominal.model.nv) == (robot.layout.nq, robot.layout.nv)
    where = {nominal.model.names[i]: nominal.model.idx_vs[i] for i in range(1, nominal.model.njoints)}
    assert [where[name] for name in robot.layout.actuated] == list(range(6, nominal.model.nv))


@pytest.mark.parametrize("seed", range(3))
def test_inertia_and_bias_equal_the_plant_s(nominal, plant, random_state, seed):
    q, v = random_state(seed)
    data = mujoco.MjData(plant)
    data.qpos[:], data.qvel[:] = q, v
    mujoco.mj_forward(plant, data)
    inertia = np.zeros((plant.nv, plant.nv))
    mujoco.mj_fullM(plant, data, inertia)
    assert np.abs(mass_matrix(nominal, q) - inertia).max() < 1e-10 * np.abs(inertia).max()
    assert np.abs(bias(nominal, q, v) - data.qfrc_bias).max() < 1e-10 * np.abs(data.qfrc_bias).max()


def test_mass_ratio_scales_links_and_rotors_alike_and_gravity_is_the_asked_one(robot, nominal, random_state):
    q, v = random_state(4)
    light, moon = NominalModel(robot, mass_ratio=0.9), NominalModel(robot, gravity_m_s2=1.62)
    np.testing.assert_allclose(mass_matrix(light, q), 0.9 * mass_matrix(nominal, q), rtol=1e-10, atol=1e-10)
    np.testing.assert_allclose(bias(light, q, v), 0.9 * bias(nominal, q, v), rtol=1e-10, atol=1e-9)
    np.testing.assert_allclose(gravity(moon, q), gravity(nominal, q) * 1.62 / 9.81, rtol=1e-9, atol=1e-9)


def test_sensor_frames_stand_where_the_plant_s_sites_do(nominal, plant, random_state):
    q, _ = random_state(6)
    data = mujoco.MjData(plant)
    data.qpos[:] = q
    mujoco.mj_forward(plant, data)
    pin.framesForwardKinematics(nominal.model, nominal.data, to_pinocchio(q))
    for side, frame in nominal.foot_frames.items():
        placement, site = nominal.data.oMf[frame], data.site(f"{side}_sole")
        np.testing.assert_allclose(placement.translation, site.xpos, atol=1e-12)
        np.testing.assert_allclose(placement.rotation, site.xmat.reshape(3, 3), atol=1e-12)
