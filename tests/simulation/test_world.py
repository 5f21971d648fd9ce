"""The compiled plant is the one that the configuration asks for."""

from __future__ import annotations

from typing import Any

import mujoco
import numpy as np
import pytest

from mobnet.core.errors import ConfigError
from mobnet.robot.description import RobotDescription
from mobnet.simulation.world import leg_mask, make_world


def test_options_are_those_the_truth_is_aligned_with(full_config: dict[str, Any], robot: RobotDescription) -> None:
    option = make_world(full_config, robot, "checks", "ideal").model.opt
    assert option.timestep == 1 / full_config["rates"]["plant_hz"] == 0.0005
    assert option.integrator == mujoco.mjtIntegrator.mjINT_EULER
    assert option.jacobian == mujoco.mjtJacobian.mjJAC_DENSE  # the truth reads dense contact rows
    assert option.noslip_iterations == 0
    np.testing.assert_array_equal(option.gravity, [0, 0, -9.81])


@pytest.mark.parametrize(("level", "present"), [("ideal", 0), ("sensor_noise", 0), ("all_uncertainty", 1)])
def test_level_switches_friction_loss(
    full_config: dict[str, Any], robot: RobotDescription, level: str, present: int
) -> None:
    model = make_world(full_config, robot, "flat", level).model
    np.testing.assert_array_equal(model.dof_frictionloss[:6], 0)
    np.testing.assert_array_equal(model.dof_frictionloss[6:], present * np.where(leg_mask(robot), 10.0, 8.0))
    assert not model.dof_damping.any()


def test_every_geom_has_the_configured_contact(full_config: dict[str, Any], robot: RobotDescription) -> None:
    model, plant = make_world(full_config, robot, "checks", "ideal").model, full_config["plant"]
    touching = model.geom_contype != 0
    assert set(model.geom_friction[touching, 0]) == {plant["contact_friction"]}
    expected = [plant["contact_time_constant_s"], plant["contact_damping_ratio"]]
    np.testing.assert_allclose(model.geom_solref[touching], np.tile(expected, (touching.sum(), 1)))


def test_plant_keeps_the_true_masses_at_every_level(full_config: dict[str, Any], robot: RobotDescription) -> None:
    for level in full_config["levels"]:
        mass = make_world(full_config, robot, "flat", level).model.body_mass.sum()
        assert mass == pytest.approx(robot.mass, rel=1e-12)


def test_leg_mask_is_the_first_twelve_motors(robot: RobotDescription) -> None:
    np.testing.assert_array_equal(np.flatnonzero(leg_mask(robot)), np.arange(12))


@pytest.mark.parametrize(("terrain", "level"), [("stairs", "ideal"), ("flat", "perfect")])
def test_unknown_terrain_or_level_is_named(
    full_config: dict[str, Any], robot: RobotDescription, terrain: str, level: str
) -> None:
    with pytest.raises(ConfigError, match=r"(stairs|perfect)' is not accepted; accepted: "):
        make_world(full_config, robot, terrain, level)
