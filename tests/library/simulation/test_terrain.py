"""Uneven ground: heights, slopes, period, and what is drawn of it."""

import mujoco
import numpy as np
import pytest

from mobnet.core.errors import ConfigError
from mobnet.robot.plant import SOLE_TYPE, TERRAIN_TYPE
from mobnet.settings import data
from mobnet.simulation.terrain import REACH_M, TERRAIN_GROUP, add_terrain, draw_terrain, frustum

SEEDS = range(4)
TERRAINS = tuple(data.Terrain.model_fields)


def build(terrain, half_width=None):
    """Return a world with nothing but the terrain, and its height (n,) [m] under points (n, 2) [m]."""
    spec = mujoco.MjSpec()
    add_terrain(spec, terrain, half_width)
    model = spec.compile()
    data, hit, down = mujoco.MjData(model), np.zeros(1, dtype=np.int32), np.array([0.0, 0.0, -1.0])
    mujoco.mj_kinematics(model, data)

    def heights(points):
        starts = np.column_stack([points, np.ones(len(points))])
        return 1.0 - np.array([mujoco.mj_ray(model, data, start, down, None, 1, -1, hit) for start in starts])

    return model, heights


@pytest.fixture
def draw(settings):
    """A function (name, seed) -> a terrain."""
    return lambda name, seed=0: draw_terrain(dict(settings.terrain)[name], np.random.default_rng(seed))


def test_checks_are_a_drawn_share_of_cells_raised_by_one_drawn_height(draw, settings):
    checks, patterns, tops, shares = settings.terrain.checks, set[bytes](), [], []
    assert checks is not None
    cells = np.stack(np.meshgrid(*[np.arange(checks.cells)] * 2), axis=-1).reshape(-1, 2) + 0.5
    for seed in range(20):
        z = build(draw("checks", seed))[1]((cells - checks.cells / 2) * checks.cell_m)
        raised = z > 1e-9
        np.testing.assert_allclose(z[raised], z.max(), atol=1e-9)
        patterns.add(raised.tobytes())
        tops.append(z.max())
        shares.append(raised.mean())
    assert len(patterns) == 20
    assert checks.height_m[0] <= min(tops) < max(tops) <= checks.height_m[1]
    assert np.mean(shares) == pytest.approx(checks.raised_share, abs=0.05)


@pytest.mark.parametrize("name", TERRAINS)
def test_terrain_repeats_wherever_a_foot_gets(draw, name):
    """A robot beyond the edge is put back by a period: all within its reach must be the same there."""
    terrain = draw(name)
    _, heights = build(terrain)
    around = np.random.default_rng(0).uniform(-REACH_M, REACH_M, (300, 2))
    for end in ([1, 0], [0, -1], [-1, 1]):
        before = around + terrain.edge * np.array(end)
        for axis in np.flatnonzero(end):
            after = before - terrain.period * np.array(end) * (np.arange(2) == axis)
            np.testing.assert_allclose(heights(after), heights(before), atol=1e-9)


@pytest.mark.parametrize(("name", "top"), [("plates", 0.010), ("slope", 0.8 * np.tan(np.deg2rad(3)))])
def test_the_top_is_as_high_as_it_should_be(draw, name, top):
    terrain = draw(name)
    points = np.random.default_rng(0).uniform(-0.5, 0.5, (500, 2)) * terrain.period
    z = build(terrain)[1](points)
    assert z.max() == pytest.approx(top, abs=1e-6)
    assert z.min() == pytest.approx(0, abs=1e-12)


@pytest.mark.parametrize(("name", "steepest"), [("checks", 2.0), ("plates", 1.0), ("slope", np.tan(np.deg2rad(3)))])
def test_no_side_is_vertical(draw, name, steepest):
    """Along lines through a whole period, points 1 mm apart differ by as much as the steepest side allows at most."""
    terrain = draw(name)
    _, heights = build(terrain)
    rng, steps = np.random.default_rng(1), []
    for _ in range(8):
        yaw = rng.uniform(0, np.pi)
        along = np.arange(-terrain.period / 2, terrain.period / 2, 1e-3)[:, None] * [np.cos(yaw), np.sin(yaw)]
        z = heights(along + rng.uniform(-0.3, 0.3, 2))
        steps.append(np.abs(np.diff(z)).max())
    assert 0.7 * steepest * 1e-3 < max(steps) <= steepest * 1e-3 + 1e-6


@pytest.mark.parametrize("seed", SEEDS)
def test_slope_rises_by_three_degrees_both_ways_and_is_even(draw, seed):
    terrain = draw("slope", seed)
    _, heights = build(terrain)
    line = np.arange(-terrain.period / 2, terrain.period / 2, 0.01)
    profiles = [heights(np.column_stack([line * (axis == k) for k in range(2)])) for axis in range(2)]
    along, across = sorted(profiles, key=np.ptp, reverse=True)
    angle = np.rad2deg(np.arctan(np.diff(along) / 0.01))
    for wanted, share in ((3.0, 0.8 / 2.6), (-3.0, 0.8 / 2.6), (0.0, 1.0 / 2.6)):
        assert np.mean(np.abs(angle - wanted) < 1e-3) == pytest.approx(share, abs=0.02)
    assert np.ptp(across) < 1e-9


def test_slopes_go_either_way_and_begin_anywhere(draw):
    places = [draw("slope", seed).pieces[0].place for seed in range(20)]
    assert {int(np.flatnonzero(place)[0]) for place in places} == {0, 1}
    assert np.ptp([place.sum() for place in places]) > 1.3


@pytest.mark.parametrize("seed", range(20))
def test_plates_keep_apart_all_over_the_world(draw, seed):
    """Points all over each plate lie in no other plate, nor in a copy of one beyond the period's edge."""
    terrain = draw("plates", seed)
    areas, grid = [], np.stack(np.meshgrid(*[np.linspace(-1, 1, 21)] * 2), axis=-1).reshape(-1, 2)
    assert len(terrain.pieces) == 3
    for plate in terrain.pieces:
        areas.append(4 * plate.bottom.prod())
        points = plate.place + (grid * plate.bottom) @ rotation(plate.yaw).T
        for other in terrain.pieces:
            for i, j in np.ndindex(3, 3):
                centre = other.place + terrain.period * (np.array([i, j]) - 1)
                inside = (np.abs((points - centre) @ rotation(other.yaw)) < other.bottom + 0.019).all(axis=1)
                assert not inside.any() or (other is plate and (i, j) == (1, 1))
    np.testing.assert_allclose(areas, [0.54, 0.36, 0.27])


def rotation(yaw):
    return np.array([[np.cos(yaw), -np.sin(yaw)], [np.sin(yaw), np.cos(yaw)]])


def test_a_wider_terrain_is_the_same_terrain(draw):
    for name in TERRAINS:
        terrain = draw(name)
        points = np.random.default_rng(2).uniform(-REACH_M, REACH_M, (200, 2))
        np.testing.assert_allclose(build(terrain, 6.0)[1](points), build(terrain)[1](points), atol=1e-9)


def test_plates_without_room_are_named(settings):
    plates = settings.terrain.plates.model_copy(update={"period_m": 1.0})
    with pytest.raises(ConfigError, match=r"no room for a plate of \[0\.\d+, 0\.\d+\] m in a period of 1\.0 m"):
        draw_terrain(plates, np.random.default_rng(0))


def test_flat_is_the_ground_alone(draw):
    model, heights = build(draw("flat"))
    assert model.ngeom == 1
    assert heights(np.array([[0.3, 7.0]])) == pytest.approx(0, abs=1e-12)


@pytest.mark.parametrize("name", TERRAINS)
def test_only_soles_touch_the_terrain(draw, name):
    model, _ = build(draw(name))
    assert set(model.geom_contype) == {TERRAIN_TYPE}
    assert set(model.geom_conaffinity) == {SOLE_TYPE}
    assert set(model.geom_group) == {TERRAIN_GROUP}


def test_frustum_is_symmetric_and_stands_on_the_ground():
    corners = frustum(np.array([0.15, 0.3]), np.array([0.14, 0.29]), 0.015)
    np.testing.assert_allclose(corners.mean(axis=0), [0, 0, 0.0075], atol=1e-15)
    np.testing.assert_array_equal(np.abs(corners[corners[:, 2] == 0]), np.tile([0.15, 0.3, 0.0], (4, 1)))
