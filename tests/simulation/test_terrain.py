"""Uneven ground: heights and period."""

from __future__ import annotations

from typing import Any

import mujoco
import numpy as np
import pytest

from mobnet.core.errors import ConfigError
from mobnet.robot.plant import SOLE_TYPE, TERRAIN_TYPE
from mobnet.simulation.terrain import add_terrain, frustum, top_of


def compile_terrain(settings: dict[str, Any], name: str) -> tuple[mujoco.MjModel, mujoco.MjData, float]:
    """Return a world with nothing but the terrain, and its period [m]."""
    spec = mujoco.MjSpec()
    period = add_terrain(spec, name, settings)
    model = spec.compile()
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    return model, data, period


def height(model: mujoco.MjModel, data: mujoco.MjData, x: float, y: float) -> float:
    """Return the ground's height [m] under a point."""
    hit = np.zeros(1, dtype=np.int32)
    return 1.0 - mujoco.mj_ray(model, data, np.array([x, y, 1.0]), np.array([0.0, 0.0, -1.0]), None, 1, -1, hit)


def test_checks_are_up_and_down_in_turn(full_config: dict[str, Any]) -> None:
    model, data, _ = compile_terrain(full_config["terrain"], "checks")
    cell = full_config["terrain"]["checks"]["cell_m"]
    for i in range(-3, 3):
        for j in range(-3, 3):
            up = (i + j) % 2 == 0
            z = height(model, data, (i + 0.5) * cell, (j + 0.5) * cell)
            assert z == pytest.approx(0.015 * up, abs=1e-6)


def test_terrain_repeats_after_its_period(full_config: dict[str, Any]) -> None:
    model, data, period = compile_terrain(full_config["terrain"], "checks")
    points = np.random.default_rng(0).uniform(-0.6, 0.6, (200, 2))
    heights = np.array([height(model, data, x, y) for x, y in points])
    assert set(np.round(heights, 3)) >= {0.0, 0.015}
    for shift in ([period, 0.0], [0.0, -period]):
        moved = np.array([height(model, data, x, y) for x, y in points + shift])
        np.testing.assert_allclose(moved, heights, atol=1e-6)


def test_terrain_reaches_further_than_the_robot_goes(full_config: dict[str, Any]) -> None:
    """The robot is put back after a period; a long step and a foot must still find ground there."""
    checks = full_config["terrain"]["checks"]
    _, _, period = compile_terrain(full_config["terrain"], "checks")
    assert checks["cells"] * checks["cell_m"] / 2 >= period + 0.6


def test_edges_slope(full_config: dict[str, Any]) -> None:
    model, data, _ = compile_terrain(full_config["terrain"], "checks")
    checks = full_config["terrain"]["checks"]
    z = [height(model, data, checks["cell_m"] - share * checks["bevel_m"], 0.15) for share in (0.25, 0.5, 0.75)]
    np.testing.assert_allclose(z, checks["height_m"] * np.array([0.25, 0.5, 0.75]), atol=1e-5)


def test_flat_is_flat_and_has_no_top(full_config: dict[str, Any]) -> None:
    model, data, period = compile_terrain(full_config["terrain"], "flat")
    assert model.ngeom == 1
    assert height(model, data, 0.3, 7.0) == pytest.approx(0, abs=1e-12)
    assert period > 0
    assert [top_of(name, full_config["terrain"]) for name in ("flat", "checks")] == [0.0, 0.015]


def test_only_soles_touch_the_terrain(full_config: dict[str, Any]) -> None:
    model, _, _ = compile_terrain(full_config["terrain"], "checks")
    assert set(model.geom_contype) == {TERRAIN_TYPE}
    assert set(model.geom_conaffinity) == {SOLE_TYPE}


def test_frustum_is_symmetric_and_stands_on_the_ground() -> None:
    corners = frustum(0.15, 0.14, 0.015)
    np.testing.assert_allclose(corners.mean(axis=0), [0, 0, 0.0075], atol=1e-15)
    assert np.abs(corners[corners[:, 2] == 0]).max() == 0.15


def test_unknown_terrain_is_named(full_config: dict[str, Any]) -> None:
    with pytest.raises(ConfigError, match="terrain: 'stairs' is not accepted; accepted: checks, flat"):
        add_terrain(mujoco.MjSpec(), "stairs", full_config["terrain"])
