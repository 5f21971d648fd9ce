"""Obstacles: springs as stiff as they are told, that meet the robot alone, in front of where it starts."""

import mujoco
import numpy as np
import pytest
from library_settings import library_settings, walk_settings

from mobnet.simulation.obstacles import PREFIX, obstacle_force, points_on
from mobnet.simulation.simulator import Simulator

SETTINGS = library_settings()


def started(scenario="knee_bar", seed=1):
    simulator = Simulator(walk_settings(SETTINGS, scenario, "ideal"), seed)
    simulator.start()
    return simulator


def put_into(simulator, link):
    """Put the bar, 0.47 m up and to the left in its body, into the middle of a link."""
    model, data = simulator.world.model, simulator.world.data
    model.body("obstacle_knee_bar").pos[:] = data.geom_xpos[model.geom(link).id] - model.geom("obstacle_knee_bar_0").pos
    mujoco.mj_forward(model, data)


def test_the_robot_faces_an_obstacle_at_a_distance_that_is_drawn():
    distances = []
    for seed in range(4):
        simulator = started(seed=seed)
        place = simulator.world.model.body("obstacle_knee_bar").pos
        assert (simulator.plant.qpos[:2] == pytest.approx(0.0, abs=0.3), place[1]) == (True, 0.0)
        assert simulator.plant.qpos[3:7] == pytest.approx([1.0, 0.0, 0.0, 0.0])
        distances.append(place[0])
    low, high = SETTINGS.obstacles["knee_bar"].ahead_m
    assert low <= min(distances) < max(distances) <= high


def test_walks_without_obstacles_draw_what_they_drew():
    """The stream of obstacles is a stream of its own, so that no other walk changes."""
    simulator = Simulator(walk_settings(SETTINGS, "random_walk", "ideal"), 1)
    assert np.isfinite(simulator.plant.edge)
    model = simulator.world.model
    touched = {model.geom(geom).name for geom in [*model.pair_geom1, *model.pair_geom2]}
    assert not [name for name in touched if name.startswith(PREFIX)]


def test_a_robot_before_an_obstacle_is_not_put_back():
    assert started().plant.edge == np.inf


@pytest.mark.parametrize("link", ["left_knee", "left_thigh", "right_shank"])
def test_a_link_at_rest_in_a_pad_is_pushed_by_its_stiffness(link):
    """What the constraint asks of a link that rests and does not accelerate, over its depth in the pad."""
    simulator = started()
    model, data = simulator.world.model, simulator.world.data
    pad, geom = SETTINGS.obstacles["knee_bar"], model.geom(link).id
    data.qvel[:] = 0.0
    mujoco.mj_forward(model, data)
    put_into(simulator, link)
    touching = [c for c in data.contact if geom in (c.geom1, c.geom2) and c.dist < 0 and c.efc_address >= 0]
    assert touching
    for contact in touching:
        row = contact.efc_address
        assert data.efc_D[row] * data.efc_aref[row] == pytest.approx(-pad.stiffness_n_m * contact.dist, rel=0.02)


def test_points_of_an_obstacle_are_not_those_of_the_ground():
    simulator = started()
    model, data = simulator.world.model, simulator.world.data
    data.qpos[2] -= 0.01  # the soles press into the ground
    mujoco.mj_forward(model, data)
    put_into(simulator, "left_knee")
    bar = model.geom("obstacle_knee_bar_0").id
    own = [contact.pos for contact in data.contact if bar in (contact.geom1, contact.geom2)]
    assert 0 < len(own) < data.ncon
    np.testing.assert_array_equal(points_on(model, data), own)


def test_every_part_of_an_obstacle_meets_every_link_but_the_soles_pictures():
    simulator = started("door_frame")
    model = simulator.world.model
    met = {model.geom(g).name for pair in zip(model.pair_geom1, model.pair_geom2, strict=True) for g in pair}
    shapes = {shape.name for shape in simulator.robot.shapes}
    assert shapes - met == {"left_foot", "right_foot"}
    assert {"left_sole", "right_sole"} <= met


def test_an_obstacle_that_nothing_touches_has_no_force():
    simulator = started()
    simulator.run(np.zeros((5, simulator.width), np.float32))
    assert not obstacle_force(simulator.world.model, simulator.world.data, "knee_bar").any()


def test_friction_takes_at_most_half_of_the_speed_of_a_sliding_sole_in_a_step():
    """What the constraint asks of a sole that slides on the plate: with twice its speed, the force would alternate."""
    simulator = started("low_plate")
    model, data = simulator.world.model, simulator.world.data
    sole, speed = model.geom("left_sole").id, 0.1
    model.body("obstacle_low_plate").pos[:2] = data.geom_xpos[sole][:2] - model.geom("obstacle_low_plate_0").pos[:2]
    data.qvel[:] = 0.0
    data.qvel[1] = speed
    mujoco.mj_forward(model, data)
    plate = model.geom("obstacle_low_plate_0").id
    touching = [c for c in data.contact if {sole, plate} == {c.geom1, c.geom2} and c.efc_address >= 0]
    assert touching
    for contact in touching:
        along = data.efc_aref[contact.efc_address + 1 : contact.efc_address + 3]
        assert 0.1 < np.hypot(*along) * model.opt.timestep / speed < 0.55
