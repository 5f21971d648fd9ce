"""Pictures: the whole robot in the frame, the same every time, and one line where nothing can be drawn."""

import subprocess
import sys
from pathlib import Path

import matplotlib.image
import numpy as np
import pytest

from mobnet.core.errors import DrawingError
from mobnet.simulation import render
from mobnet.simulation.terrain import DrawnTerrain, Piece, draw_terrain

ROOT = Path(__file__).parents[3]
SMALL = (400, 300)  # width, height [pixels]
SHAPES = 2  # geom group of what is seen of the robot
NO_OPENGL = """
import ctypes, sys
load = ctypes.CDLL.__init__
def refuse(self, name, *words, **options):
    if any(part in str(name) for part in ("EGL", "libGL", "OpenGL", "OSMesa")):
        raise OSError(f"{name}: cannot open shared object file")
    load(self, name, *words, **options)
ctypes.CDLL.__init__ = refuse
from pathlib import Path
from mobnet.core.errors import DrawingError
from mobnet.robot.description import describe
from mobnet.settings.lab import load_lab
from mobnet.simulation.render import save_picture
from mobnet.simulation.terrain import DrawnTerrain
robot = describe(load_lab().robot)
q = [0.0] * robot.layout.nq
q[3] = 1.0
try:
    save_picture(robot, DrawnTerrain(1.0), q, Path(sys.argv[1]))
except DrawingError as error:
    print(error)
"""


@pytest.fixture(scope="module")
def terrain(settings):
    return draw_terrain(settings.terrain.checks, np.random.default_rng(0))


@pytest.fixture(scope="module")
def model(robot, terrain):
    return render.picture_model(robot, terrain, SMALL)


@pytest.fixture(scope="module")
def upright(robot):
    q = np.zeros(robot.layout.nq)
    q[2], q[3] = 0.96, 1.0
    return q


def draw(model, q):
    (pixels,) = render.draw_frames(model, [q])
    return pixels


@pytest.fixture(scope="module")
def pixels(model, upright):
    try:
        return draw(model, upright)
    except DrawingError as error:
        pytest.skip(str(error))


def test_the_robot_fills_the_frame_and_is_not_cut_off(model, upright, pixels):
    robot = model.geom_group == SHAPES
    colours = model.geom_rgba.copy()
    model.geom_rgba[robot] = 0
    rows = np.flatnonzero((draw(model, upright) != pixels).any(axis=(1, 2)))
    model.geom_rgba[:] = colours
    assert rows[0] > 0
    assert rows[-1] < len(pixels) - 1
    assert rows[-1] - rows[0] > 0.8 * len(pixels)


def test_camera_and_shadow_follow_a_robot_that_walked_some_periods(model, terrain, upright, pixels):
    """The picture then is the same but for rounding: the robot's shadow, and the ground near it, moved along."""
    moved = upright.copy()
    moved[:2] += terrain.period * np.array([3, -2])
    difference = np.abs(draw(model, moved).astype(int) - pixels).max(axis=2)
    assert np.mean(difference > 8) < 0.01


def test_frames_are_what_one_by_one_would_be(model, upright, pixels):
    """One OpenGL context draws them all, and none is left behind in the next."""
    turned = upright.copy()
    turned[[3, 6]] = np.cos(0.5), np.sin(0.5)
    frames = list(render.draw_frames(model, [upright, turned, upright]))
    for frame, alone in zip(frames, (pixels, draw(model, turned), pixels), strict=True):
        assert np.mean((frame != alone).any(axis=2)) < 1e-3  # of two solids at one place, either may be in front
    assert np.mean((frames[1] != pixels).any(axis=2)) > 0.02


def test_frames_are_drawn_only_as_they_are_asked_for(model, upright, pixels):
    asked = []
    frames = render.draw_frames(model, (asked.append(k) or upright for k in range(100)))
    next(frames)
    next(frames)
    frames.close()
    assert asked == [0, 1]


def test_a_picture_has_the_size_asked_for(robot, terrain, upright, pixels):
    assert draw(render.picture_model(robot, terrain, (200, 100)), upright).shape == (100, 200, 3)
    assert pixels.shape == (*SMALL[::-1], 3)


def test_the_terrain_that_was_drawn_is_seen(settings, robot, upright, pixels):
    a, b, c = (draw_terrain(settings.terrain.plates, np.random.default_rng(seed)) for seed in (1, 1, 2))
    a, b, c = (draw(render.picture_model(robot, terrain, (200, 150)), upright) for terrain in (a, b, c))
    np.testing.assert_array_equal(a, b)
    assert np.mean((a != c).any(axis=2)) > 0.05


def test_the_file_holds_what_was_drawn(robot, terrain, upright, pixels, tmp_path):
    render.save_picture(robot, terrain, upright, tmp_path / "robot.png")
    written = matplotlib.image.imread(tmp_path / "robot.png")[..., :3]
    np.testing.assert_array_equal(np.round(written * 255), draw(render.picture_model(robot, terrain), upright))


def test_without_opengl_one_line_names_the_packages_and_nothing_is_written(tmp_path):
    path = tmp_path / "robot.png"
    words = [sys.executable, "-c", NO_OPENGL, str(path)]
    done = subprocess.run(words, capture_output=True, text=True, cwd=ROOT, check=False)
    assert done.returncode == 0, done.stderr
    assert len(done.stdout.splitlines()) == 1
    assert render.PACKAGES in done.stdout
    assert not list(tmp_path.iterdir())


def test_a_drawn_piece_without_an_end_ends_at_half_a_period():
    """Light and fog are computed at corners alone."""
    strip = Piece(np.array([np.inf, 0.3]), np.array([np.inf, 0.2]), 0.05, np.zeros(2))
    wide = Piece(np.array([0.3, 2.5]), np.array([0.2, 2.5]), 0.05, np.ones(2))
    first, second = render._cut(DrawnTerrain(4.0, (strip, wide))).pieces
    assert (first.bottom.tolist(), first.top.tolist()) == ([2.0, 0.3], [2.0, 0.2])
    assert (second.bottom.tolist(), second.top.tolist()) == ([0.3, 2.0], [0.2, 2.0])
