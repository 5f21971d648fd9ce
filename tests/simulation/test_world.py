"""The compiled plant is the one that the configuration asks for."""

from collections.abc import Callable

import mujoco
import numpy as np
import pytest

from mobnet.robot.description import RobotDescription
from mobnet.settings.settings import Settings
from mobnet.simulation.terrain import draw_terrain
from mobnet.simulation.world import World, ground_height, leg_mask, make_world

Build = Callable[..., World]


@pytest.fixture
def build(settings: Settings, robot: RobotDescription) -> Build:
    """A function (terrain, level, seed) -> a world."""

    def make(terrain: str, level: str = "ideal", seed: int = 0) -> World:
        drawn = draw_terrain(dict(settings.terrain)[terrain], np.random.default_rng(seed))
        return make_world(robot, drawn, settings.plant, settings.levels[level], settings.rates.plant_hz)

    return make


def test_options_are_those_the_truth_is_aligned_with(build: Build) -> None:
    option = build("checks").model.opt
    assert option.timestep == 0.0005
    assert option.integrator == mujoco.mjtIntegrator.mjINT_EULER
    assert option.jacobian == mujoco.mjtJacobian.mjJAC_DENSE  # the truth reads dense contact rows
    assert option.noslip_iterations == 0
    np.testing.assert_array_equal(option.gravity, [0, 0, -9.81])


@pytest.mark.parametrize(("level", "present"), [("ideal", 0), ("sensor_noise", 0), ("all_uncertainty", 1)])
def test_level_switches_friction_loss(build: Build, robot: RobotDescription, level: str, present: int) -> None:
    model = build("flat", level).model
    np.testing.assert_array_equal(model.dof_frictionloss[:6], 0)
    np.testing.assert_array_equal(model.dof_frictionloss[6:], present * np.where(leg_mask(robot), 10.0, 8.0))
    assert not model.dof_damping.any()


def test_every_geom_has_the_configured_contact(build: Build, settings: Settings) -> None:
    model, plant = build("checks").model, settings.plant
    touching = model.geom_contype != 0
    assert set(model.geom_friction[touching, 0]) == {plant.contact_friction}
    expected = [plant.contact_time_constant_s, plant.contact_damping_ratio]
    np.testing.assert_allclose(model.geom_solref[touching], np.tile(expected, (touching.sum(), 1)))


def test_plant_keeps_the_true_masses_at_every_level(build: Build, settings: Settings, robot: RobotDescription) -> None:
    for level in settings.levels:
        mass = build("flat", level).model.body_mass.sum()
        assert mass == pytest.approx(robot.mass, rel=1e-12)


def test_leg_mask_is_the_first_twelve_motors(robot: RobotDescription) -> None:
    np.testing.assert_array_equal(np.flatnonzero(leg_mask(robot)), np.arange(12))


@pytest.mark.parametrize("name", ["checks", "flat", "plates", "slope"])
def test_rays_find_the_heights_of_what_stands_there(build: Build, name: str) -> None:
    """The pieces' own figures tell the height without a ray; the robot is no ground, also after a reset."""
    world = build(name, seed=3)
    points = np.random.default_rng(4).uniform(-0.5, 0.5, (500, 2)) * world.period
    found = ground_height(world, points)
    np.testing.assert_allclose(found, heights_of_pieces(world, points), atol=1e-6)
    mujoco.mj_resetData(world.model, world.data)
    np.testing.assert_array_equal(ground_height(world, points), found)


def heights_of_pieces(world: World, points: np.ndarray) -> np.ndarray:
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


def test_same_generator_builds_the_same_world(build: Build) -> None:
    a, b, c = (build("plates", seed=seed) for seed in (1, 1, 2))
    np.testing.assert_array_equal(a.model.geom_pos, b.model.geom_pos)
    assert a.model.geom_pos.shape != c.model.geom_pos.shape or not np.array_equal(a.model.geom_pos, c.model.geom_pos)
