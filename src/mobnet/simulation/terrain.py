"""Uneven ground (Figure 3 a) that repeats, so that a robot which has walked one period can be put back."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import mujoco
import numpy as np
from numpy.typing import NDArray

from mobnet.core.errors import ConfigError, not_accepted
from mobnet.robot.plant import SOLE_TYPE, TERRAIN_TYPE

TERRAINS = ("checks", "flat")
GROUND_RGBA = (0.55, 0.57, 0.60, 1.0)
CHECK_RGBA = (0.75, 0.63, 0.45, 1.0)
FLAT_PERIOD_M = 1.0  # flat ground repeats at any length


def add_terrain(spec: mujoco.MjSpec, name: str, settings: Mapping[str, Any]) -> float:
    """Add the ground z = 0 and what stands on it; return the period [m] after which it repeats in x and y.

    Raises:
        ConfigError: the terrain is unknown.
    """
    if name not in TERRAINS:
        raise ConfigError(not_accepted("terrain", name, TERRAINS))
    spec.worldbody.add_geom(
        name="ground", type=mujoco.mjtGeom.mjGEOM_PLANE, size=[0, 0, 1], contype=TERRAIN_TYPE, conaffinity=SOLE_TYPE,
        rgba=GROUND_RGBA,
    )  # fmt: skip
    return _add_checks(spec, settings[name]) if name == "checks" else FLAT_PERIOD_M


def top_of(name: str, settings: Mapping[str, Any]) -> float:
    """Return the height of the terrain's highest point [m]."""
    return float(settings[name].get("height_m", 0.0))


def _add_checks(spec: mujoco.MjSpec, checks: Mapping[str, Any]) -> float:
    """Add every other cell of a checkerboard as a bevelled plate; its edges slope, or a tilted sole jams on them."""
    half, bevel, height = checks["cell_m"] / 2, checks["bevel_m"], checks["height_m"]
    spec.add_mesh(name="check", uservert=frustum(half, half - bevel, height).ravel())
    cells = int(checks["cells"])
    for i in range(cells):
        for j in range(cells):
            if (i + j) % 2 == 0:
                place = (np.array([i, j]) - (cells - 1) / 2) * checks["cell_m"]
                spec.worldbody.add_geom(
                    type=mujoco.mjtGeom.mjGEOM_MESH, meshname="check", pos=[*place, 0.0], contype=TERRAIN_TYPE,
                    conaffinity=SOLE_TYPE, rgba=CHECK_RGBA,
                )  # fmt: skip
    return 2 * checks["cell_m"]


def frustum(bottom: float, top: float, height: float) -> NDArray[np.float64]:
    """Return the corners (8, 3) [m] of a square frustum of half widths bottom and top [m] on z = 0."""
    square = np.array([[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]])
    return np.vstack([np.c_[square * bottom, np.zeros(4)], np.c_[square * top, np.full(4, height)]])
