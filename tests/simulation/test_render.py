"""Pictures: the whole robot in the frame, the same every time, and one line where nothing can be drawn."""

import logging
import subprocess
import sys
from pathlib import Path

import matplotlib.image
import numpy as np
import pytest

from mobnet.robot.description import load_robot
from mobnet.simulation import render
from mobnet.simulation.__main__ import main

ROOT = Path(__file__).parents[2]
SHAPES = 2  # geom group of what is seen of the robot
NO_OPENGL = f"""
import ctypes, sys
load = ctypes.CDLL.__init__
def refuse(self, name, *words, **options):
    if any(part in str(name) for part in ("EGL", "libGL", "OpenGL", "OSMesa")):
        raise OSError(f"{{name}}: cannot open shared object file")
    load(self, name, *words, **options)
ctypes.CDLL.__init__ = refuse
from pathlib import Path
from mobnet.core.config import load_config
from mobnet.robot.description import load_robot
from mobnet.simulation.render import save_picture
config = load_config(Path({str(ROOT / "configs" / "config.yaml")!r}))
robot = load_robot(Path(config["robot"]))
q = [0.0] * robot.layout.nq
q[3] = 1.0
sys.exit(save_picture(config, robot, "flat", q, Path(sys.argv[1])))
"""


@pytest.fixture(scope="module")
def robot(full_config):
    return load_robot(Path(full_config["robot"]))


@pytest.fixture(scope="module")
def model(full_config, robot):
    return render.picture_model(full_config, robot, "checks")


@pytest.fixture(scope="module")
def upright(robot):
    q = np.zeros(robot.layout.nq)
    q[2], q[3] = 0.96, 1.0
    return q


@pytest.fixture(scope="module")
def pixels(model, upright):
    try:
        return render.draw(model, upright)
    except (ImportError, AttributeError) as error:
        pytest.skip(f"no EGL here ({error}); Debian packages: {render.PACKAGES}")


def test_the_robot_fills_the_frame_and_is_not_cut_off(model, upright, pixels):
    robot = model.geom_group == SHAPES
    colours = model.geom_rgba.copy()
    model.geom_rgba[robot] = 0
    rows = np.flatnonzero((render.draw(model, upright) != pixels).any(axis=(1, 2)))
    model.geom_rgba[:] = colours
    assert rows[0] > 0
    assert rows[-1] < len(pixels) - 1
    assert rows[-1] - rows[0] > 0.8 * len(pixels)


def test_the_same_state_gives_the_same_picture(model, upright, pixels):
    np.testing.assert_array_equal(render.draw(model, upright), pixels)


def test_the_camera_follows_the_robot(model, upright, pixels):
    period = 0.6
    moved = upright.copy()
    moved[0] += period
    difference = np.abs(render.draw(model, moved).astype(int) - pixels)
    assert np.median(difference) <= 1


def test_the_file_holds_what_was_drawn(full_config, robot, upright, pixels, tmp_path):
    assert render.save_picture(full_config, robot, "checks", upright, tmp_path / "robot.png")
    written = matplotlib.image.imread(tmp_path / "robot.png")[..., :3]
    np.testing.assert_array_equal(np.round(written * 255), pixels)


def test_without_opengl_one_line_names_the_packages_and_nothing_is_written(tmp_path):
    path = tmp_path / "robot.png"
    words = [sys.executable, "-c", NO_OPENGL, str(path)]
    done = subprocess.run(words, capture_output=True, text=True, cwd=ROOT, check=False)
    assert done.returncode == 0, done.stderr
    assert len(done.stderr.splitlines()) == 1
    assert render.PACKAGES in done.stderr
    assert not list(tmp_path.iterdir())


@pytest.mark.slow
@pytest.mark.sim
def test_the_command_draws_a_walking_robot(pixels, tmp_path, monkeypatch, caplog):
    monkeypatch.chdir(ROOT)
    caplog.set_level(logging.INFO)
    assert main(["--seconds", "1", "--picture", str(tmp_path / "walking.png")]) == 0
    assert matplotlib.image.imread(tmp_path / "walking.png").shape[:2] == pixels.shape[:2]
    assert "steps in" in caplog.text


def test_a_duration_that_is_not_positive_is_named(monkeypatch, caplog):
    monkeypatch.chdir(ROOT)
    assert main(["--seconds", "-1"]) == 1
    assert "--seconds: -1.0" in caplog.text
