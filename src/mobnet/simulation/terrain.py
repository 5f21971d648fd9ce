"""Uneven ground (Figure 3) that repeats, so that a robot which has walked one period can be put back.

Whatever stands on the even ground is a frustum, because a tilted sole would jam at vertical sides.
"""

from collections.abc import Iterator
from itertools import product
from typing import NamedTuple

import mujoco
import numpy as np

from mobnet.core.arrays import Array
from mobnet.core.errors import ConfigError
from mobnet.robot.plant import SOLE_TYPE, TERRAIN_TYPE
from mobnet.settings.data import Checks, Flat, Plates, Slope

TERRAIN_GROUP = 0  # geom group of the ground and what stands on it
GROUND_RGBA = (0.55, 0.57, 0.60, 1.0)
WOOD_RGBA = (0.75, 0.63, 0.45, 1.0)
FLAT_PERIOD_M = 1.0  # flat ground repeats at any length
REACH_M = 0.9  # no foot is ever further from the pelvis
EDGE_PERIODS = 0.6  # more than one half, so that a robot that was put back does not come back at its next step
DRAWS_MAX = 1000  # of one plate's place
ROUND_OFF_M = 1e-9


class Piece(NamedTuple):
    """A frustum on z = 0 that repeats."""

    bottom: Array  # half widths (2,) at its foot [m]; infinite where it has no end
    top: Array  # half widths (2,) at its top [m]
    height: float  # [m]
    place: Array  # centre (2,) [m]
    yaw: float = 0.0  # [rad]


class DrawnTerrain(NamedTuple):
    """Even ground and what stands on one period of it."""

    period: float  # length after which the terrain repeats in x and y [m]
    pieces: tuple[Piece, ...] = ()  # what stands on one period

    @property
    def edge(self) -> float:
        """Return the distance from the origin in x or y beyond which the robot is put back by a period [m]."""
        return EDGE_PERIODS * self.period


def draw_terrain(row: Checks | Flat | Plates | Slope, rng: np.random.Generator) -> DrawnTerrain:
    """Draw a terrain of section 4.3: which checks are raised and how high, where plates lie, which way a slope goes.

    Raises:
        ConfigError: the plates find no room.
    """
    match row:
        case Checks():
            return _checks(row, rng)
        case Plates():
            return _plates(row, rng)
        case Slope():
            return _slope(row, rng)
        case Flat():
            return DrawnTerrain(FLAT_PERIOD_M)


def top_of(terrain: DrawnTerrain) -> float:
    """Return the height of the terrain's highest point [m]."""
    return max((piece.height for piece in terrain.pieces), default=0.0)


def _checks(row: Checks, rng: np.random.Generator) -> DrawnTerrain:
    """Return drawn cells of a square field, all raised by one drawn height (Figure 3 a)."""
    half = np.full(2, row.cell_m / 2)
    height = rng.uniform(*row.height_m)
    raised = np.argwhere(rng.random((row.cells, row.cells)) < row.raised_share)
    places = (raised - (row.cells - 1) / 2) * row.cell_m
    pieces = tuple(Piece(half, half - row.bevel_m, height, place) for place in places)
    return DrawnTerrain(row.cells * row.cell_m, pieces)


def _plates(row: Plates, rng: np.random.Generator) -> DrawnTerrain:
    """Return plates at random places that do not touch each other, across the period's edge neither (Figure 3 b)."""
    period = row.period_m
    plates: list[Piece] = []
    for size in row.sizes_m:
        half = np.array(size) / 2
        for _ in range(DRAWS_MAX):
            place = rng.uniform(-0.5, 0.5, 2) * period
            yaw = rng.uniform(0, np.pi)
            plate = Piece(half, half - row.bevel_m, row.height_m, place, yaw)
            if all(_apart(plate, other, period, row.gap_m) for other in (*plates, plate)):
                plates.append(plate)
                break
        else:
            raise ConfigError(f"terrain.plates: no room for a plate of {list(size)} m in a period of {period} m")
    return DrawnTerrain(period, tuple(plates))


def _slope(row: Slope, rng: np.random.Generator) -> DrawnTerrain:
    """Return even ground, a slope up, even ground and a slope down, along x or y (Figure 3 c)."""
    run = row.slope_m
    even = row.even_m
    period = 2 * (run + even)
    along = rng.integers(2)
    place = rng.uniform(-0.5, 0.5) * period
    bottom = np.full(2, np.inf)
    top = np.full(2, np.inf)
    centre = np.zeros(2)
    bottom[along] = even / 2 + run
    top[along] = even / 2
    centre[along] = place
    return DrawnTerrain(period, (Piece(bottom, top, run * np.tan(np.deg2rad(row.angle_deg)), centre),))


def _apart(a: Piece, b: Piece, period: float, gap: float) -> bool:
    """Return whether a piece and all copies of another keep a gap [m]; a piece is no copy of itself.

    Two convex figures are apart where one of their sides' directions separates them.
    """
    cells = product((-1, 0, 1), repeat=2)
    offsets = np.array([b.place - a.place + period * np.array(cell) for cell in cells])
    offsets = offsets[offsets.any(axis=1)]
    sides = np.hstack([_turn(a.yaw), _turn(b.yaw)])
    reach = sum(np.abs(sides.T @ _turn(piece.yaw)) @ piece.bottom for piece in (a, b))
    return bool((np.abs(offsets @ sides) > reach + gap).any(axis=1).all())


def _turn(yaw: float) -> Array:
    """Return the rotation (2, 2) by an angle [rad]."""
    return np.array([[np.cos(yaw), -np.sin(yaw)], [np.sin(yaw), np.cos(yaw)]])


def add_terrain(spec: mujoco.MjSpec, terrain: DrawnTerrain, half_width: float | None = None) -> None:
    """Add the ground z = 0 and all that stands on it within a half width [m]; without one, as far as a robot gets."""
    half_width = terrain.edge + REACH_M if half_width is None else half_width
    touch = {"contype": TERRAIN_TYPE, "conaffinity": SOLE_TYPE, "group": TERRAIN_GROUP}
    spec.worldbody.add_geom(name="ground", type=mujoco.mjtGeom.mjGEOM_PLANE, size=[0, 0, 1], rgba=GROUND_RGBA, **touch)
    for number, piece in enumerate(terrain.pieces):
        bottom = np.minimum(piece.bottom, half_width)
        top = np.minimum(piece.top, half_width)
        spec.add_mesh(name=f"piece{number}", uservert=frustum(bottom, top, piece.height).ravel())
        for x, y in _copies(piece, terrain.period, half_width):
            spec.worldbody.add_geom(
                type=mujoco.mjtGeom.mjGEOM_MESH,
                meshname=f"piece{number}",
                pos=[x, y, 0.0],
                rgba=WOOD_RGBA,
                quat=[np.cos(piece.yaw / 2), 0.0, 0.0, np.sin(piece.yaw / 2)],
                **touch,
            )


def _copies(piece: Piece, period: float, half_width: float) -> Iterator[Array]:
    """Yield the centres (2,) [m] of the copies that reach into a square of that half width [m]."""
    endless = np.isinf(piece.bottom)
    reach = np.abs(_turn(piece.yaw)) @ np.where(endless, 0.0, piece.bottom)
    most = int(np.ceil(half_width / period)) + 1
    for shift in np.ndindex(2 * most + 1, 2 * most + 1):
        number = np.array(shift) - most
        place = piece.place + period * number
        if not (number[endless].any() or (np.abs(place) - reach > half_width - ROUND_OFF_M).any()):
            yield place


def frustum(bottom: Array, top: Array, height: float) -> Array:
    """Return the corners (8, 3) [m] of a frustum of half widths bottom (2,) and top (2,) [m] on z = 0."""
    square = np.array([[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]])
    return np.vstack([np.c_[square * bottom, np.zeros(4)], np.c_[square * top, np.full(4, height)]])
