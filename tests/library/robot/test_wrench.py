"""J^T F of (2) against MuJoCo, against power, and against the contact solver of a standing robot."""

import mujoco
import numpy as np
import pytest

from mobnet.core.arrays import rotation
from mobnet.core.errors import ConfigError
from mobnet.robot.description import SIDES
from mobnet.robot.nominal import NominalModel
from mobnet.robot.plant import robot_spec, sole_name
from mobnet.robot.wrench import feet_torque, point_torque

WRENCH = np.array([10.0, -20.0, 300.0, 4.0, -5.0, 6.0])


@pytest.mark.parametrize("side", SIDES)
def test_torque_of_a_foot_equals_the_plant_s(nominal, plant, random_state, side):
    q, _ = random_state(0)
    data = mujoco.MjData(plant)
    data.qpos[:] = q
    mujoco.mj_forward(plant, data)
    site = data.site(sole_name(side))
    axes, expected = site.xmat.reshape(3, 3), np.zeros(plant.nv)
    body = plant.body(sole_name(side)).id
    mujoco.mj_applyFT(plant, data, axes @ WRENCH[:3], axes @ WRENCH[3:], site.xpos, body, expected)
    np.testing.assert_allclose(feet_torque(nominal, q, {side: WRENCH}), expected, atol=1e-9)
    with pytest.raises(ConfigError, match="'tail' is not accepted; accepted: left, right"):
        feet_torque(nominal, q, {"tail": WRENCH})


@pytest.mark.parametrize("body", ["base_link", "L_Knee_Link", "R_Wrist2_Link", "upper", "lower", "wall"])
def test_torque_of_a_point_of_any_body_equals_the_plant_s(nominal, plant, random_state, arm, body):
    is_arm = body in [row.name for row in arm.bodies]
    model, place = (robot_spec(arm).compile() if is_arm else plant), np.array([0.02, -0.1, 0.2])
    known, q = (NominalModel(arm), np.array([0.3, -0.8])) if is_arm else (nominal, random_state(1)[0])
    axes = rotation(np.array([0.5, 0.5, -0.1, np.sqrt(0.49)]))  # of a sensor, in the body
    data, expected = mujoco.MjData(model), np.zeros(model.nv)
    data.qpos[:] = q
    mujoco.mj_forward(model, data)
    held = data.body(body)
    frame = held.xmat.reshape(3, 3)
    load, point = frame @ axes @ WRENCH.reshape(2, 3).T, held.xpos + frame @ place
    mujoco.mj_applyFT(model, data, load[:, 0], load[:, 1], point, model.body(body).id, expected)
    found = point_torque(known, body, place, axes, q[None], WRENCH[None])
    np.testing.assert_allclose(found[0], expected, atol=1e-9)
    with pytest.raises(ConfigError, match="body: 'tail' is not accepted; accepted: "):
        point_torque(known, "tail", place, axes, q[None], WRENCH[None])


def test_sum_over_feet_keeps_each_leg_to_itself(nominal, random_state):
    q = np.stack([random_state(seed)[0] for seed in range(3)])
    wrenches = {side: np.tile(WRENCH, (3, 1)) for side in SIDES}
    layout = nominal.robot.layout
    total = feet_torque(nominal, np.asfortranarray(q), {side: np.asfortranarray(w) for side, w in wrenches.items()})
    left = feet_torque(nominal, q, {"left": wrenches["left"]})
    np.testing.assert_allclose(total[:, layout.columns(layout.limb("LL"))], left[:, layout.columns(layout.limb("LL"))])
    assert not left[:, layout.columns(layout.limb("RL"))].any()
    assert not total[:, layout.columns(layout.limb("W"))].any()


@pytest.mark.sim
def test_sensor_wrenches_give_the_contact_solver_s_torque_and_the_weight(nominal, standing):
    lift = []
    for _, data, q in standing(600):
        reading = {
            side: -np.concatenate([data.sensor(f"{side}_foot_{part}").data for part in ("force", "torque")])
            for side in SIDES
        }
        torque = feet_torque(nominal, q, reading)
        push = torque - data.qfrc_constraint  # soles on the ground are the only constraints
        np.testing.assert_allclose(push[:3], data.body("left_sole").xfrc_applied[:3], atol=1e-8)
        np.testing.assert_allclose(push[12:], 0, atol=1e-8)
        lift.append(torque[2])
    assert np.mean(lift[-200:]) == pytest.approx(nominal.robot.mass * 9.81, rel=0.05)
