"""Made-up recordings: smooth random joint motion and an uncertainty torque that the inputs explain."""

import logging
from dataclasses import replace
from itertools import pairwise
from pathlib import Path

import numpy as np
import pytest
from browser import BROWSER, Browser
from library_settings import library_settings, recipes
from made_swings import unseen
from numpy.typing import NDArray
from patience import hear_ctrl_c

from mobnet.core.columns import residual_columns
from mobnet.core.joints import N_VIRTUAL, NQ_BASE, JointLayout
from mobnet.core.recording import Recording, Sensed
from mobnet.core.recording_file import write_recording
from mobnet.core.store import write_array
from mobnet.formats.loading import load_section
from mobnet.formats.robot import RobotTable
from mobnet.robot.description import describe, for_walking
from mobnet.robot.nominal import NominalModel

ROOT = Path(__file__).parents[1]
RATE_HZ = 1000.0
WAVES = 3  # sines per signal
# Minutes each; while one worker compiles for the first of them, another checks what needs nothing compiled.
LONGEST = ("world/workflow/test_smoke.py", "paper/workflow/test_static.py", "world/workflow/test_cluster.py")
# They wait for the run of the first one.
LAST = ("world/workflow/test_smoke_again.py", "world/workflow/test_smoke_killed.py")
Array = NDArray[np.float64]


def pytest_configure() -> None:
    """Let Ctrl-C reach what tests start, also where the tests run in the background."""
    hear_ctrl_c()


def pytest_collection_modifyitems(items: list[pytest.Item]) -> None:
    """Begin with the longest files: begun last, one of them would run alone on one of the workers."""
    places = {ROOT / "tests" / name: place - len(LONGEST) for place, name in enumerate(LONGEST)}
    places |= {ROOT / "tests" / name: place + 1 for place, name in enumerate(LAST)}
    items.sort(key=lambda item: places.get(item.path, 0))


@pytest.fixture(scope="session")
def settings():
    """What the library reads of the repository's configuration, with this machine's number format."""
    return library_settings()


@pytest.fixture
def saying(caplog):
    """Return a function of a command's main and its words that returns its exit status and what it said."""

    def run(main, *words):
        caplog.clear()
        with caplog.at_level(logging.INFO):
            status = main([str(word) for word in words])
        return status, [record.message for record in caplog.records if record.name == main.__module__]

    return run


@pytest.fixture(scope="session")
def robot_table():
    return load_section(ROOT / "configs" / "robots" / "tocabi.yaml", RobotTable)


@pytest.fixture(scope="session")
def recipe_of(settings):
    """Return a function of a method's name, its level, its files and other methods that makes its recipe."""
    return recipes(settings, settings.methods)


@pytest.fixture(scope="session")
def layout(robot_table):
    return robot_table.layout


@pytest.fixture(scope="session")
def robot(robot_table):
    return for_walking(describe(robot_table))


@pytest.fixture(scope="session")
def arm_table():
    return load_section(ROOT / "tests" / "data" / "arm.yaml", RobotTable)


@pytest.fixture(scope="session")
def arm(arm_table):
    return describe(arm_table)


@pytest.fixture(scope="session", params=("panda", "g1"))
def imported(request):
    """The robots whose tables were made from files of others."""
    return describe(load_section(ROOT / "configs" / "robots" / f"{request.param}.yaml", RobotTable))


@pytest.fixture(scope="session")
def nominal(robot):
    return NominalModel(robot)


@pytest.fixture(scope="session")
def made_up(layout):
    """Return a function of (seed, seconds, segments) that makes a recording up."""

    def make(seed=0, seconds=2.0, segments=1):
        return _recording(layout, np.random.default_rng(seed), round(seconds * RATE_HZ), segments)

    return make


@pytest.fixture(scope="session")
def write_pair(layout):
    """Return a function that writes a recording and a residual, and returns their stems."""

    def write(folder, recording):
        folder.mkdir(parents=True, exist_ok=True)
        stems = folder / f"recording{recording.meta['seed']}", folder / f"residual{recording.meta['seed']}"
        write_recording(stems[0], recording, layout)
        external = recording.truth.tau_ext
        array = np.concatenate([external + _uncertainty(recording.sensed, layout), external], axis=1)
        write_array(stems[1], array, residual_columns(layout), {"rate_hz": recording.rate_hz}, recording.segments)
        return stems

    return write


@pytest.fixture(scope="session")
def turned():
    """Return a function (q, v, s, yaw, shift) -> q, v and controller state turned about the world's z and shifted."""

    def turn(q, v, s, yaw, shift):
        q, v, s, c, n = q.copy(), v.copy(), s.copy(), np.cos(yaw), np.sin(yaw)
        rotation = np.array([[c, -n], [n, c]])
        for place in (q, s.old_ankle, s.lift, s.foot, s.target):
            place[:2] = rotation @ place[:2] + shift
        for direction in (v, s.velocity, s.target_velocity, s.slope):
            direction[:2] = rotation @ direction[:2]
        w, x, y, z = q[3:7]
        c, n = np.cos(yaw / 2), np.sin(yaw / 2)
        q[3:7] = c * w - n * z, c * x - n * y, c * y + n * x, c * z + n * w
        for angle in ("old_yaw", "yaw", "yaw_start", "lift_yaw"):
            s[angle] += yaw
        return q, v, s

    return turn


@pytest.fixture(scope="session")
def mirrored(robot):
    """Return a function (q, v, s) -> q, v and controller state reflected in y: left becomes right."""
    names = [joint.id for joint in robot.joints]
    images = [{"L": "R", "R": "L"}.get(name[0], name[0]) + name[1:] for name in names]
    partner = np.array([names.index(name) for name in images])
    pseudo = np.array([-1.0, 1.0, -1.0])
    sign = np.array([robot.joints[p].axis @ (pseudo * j.axis) for p, j in zip(partner, robot.joints, strict=True)])

    def mirror(q, v, s):
        q, v, s = q.copy(), v.copy(), s.copy()
        q[NQ_BASE:], v[N_VIRTUAL:] = (sign * q[NQ_BASE:])[partner], (sign * v[N_VIRTUAL:])[partner]
        for vector in (q, v, s.old_ankle, s.lift, s.foot, s.target, s.velocity, s.target_velocity, s.slope):
            vector[1] *= -1
        q[4:NQ_BASE] *= pseudo
        v[3:N_VIRTUAL] *= pseudo
        for name in ("side", "old_yaw", "yaw", "yaw_start", "lift_yaw", "lift_roll"):
            s[name] *= -1
        s.command *= [1, -1, -1, 1, 1]
        s.load, s.load_error, s.integral = s.load[::-1].copy(), s.load_error[::-1].copy(), s.integral[::-1] * [1, -1]
        return q, v, s

    return mirror


@pytest.fixture(scope="session")
def running(tmp_path_factory):
    browser = Browser(BROWSER or "", tmp_path_factory.mktemp("browser"))
    yield browser
    browser.close()


@pytest.fixture
def open_page(running):
    """A function that loads a file with a fragment; afterwards no script failed and nothing else was loaded."""
    running.events.clear()
    loaded = {"about:blank"}

    def load(page, fragment=""):
        loaded.add(page.as_uri())
        running.go(page.as_uri() + fragment)
        return running

    yield load
    asked = {event["params"]["request"]["url"] for event in running.events if event["method"].endswith("WillBeSent")}
    assert {url.split("#")[0] for url in asked if not url.startswith("data:")} <= loaded
    assert [event for event in running.events if event["method"] == "Runtime.exceptionThrown"] == []


def _recording(layout: JointLayout, rng: np.random.Generator, samples: int, segments: int) -> Recording:
    """Return sines of random frequency and phase in every signal, the base turned by a random angle."""
    time = np.arange(samples) / RATE_HZ
    q, v = np.zeros((samples, layout.nq)), np.zeros((samples, layout.nv))
    q[:, NQ_BASE:], v[:, N_VIRTUAL:] = _sines(time, layout.nu, rng, 0.3)
    angles, v[:, 3:N_VIRTUAL] = _sines(time, 3, rng, 0.1)
    half = np.linalg.norm(angles, axis=1, keepdims=True) / 2
    q[:, 3:NQ_BASE] = np.concatenate([np.cos(half), np.sinc(half / np.pi) * angles / 2], axis=1)
    torque, external = _sines(time, layout.nu, rng, 30.0)[0], _sines(time, layout.nv, rng, 20.0)[0]
    acc = _sines(time, 3, rng, 1.0)[0] + [0, 0, 9.81]
    sensed = Sensed(q, v, acc, torque, torque, np.zeros((samples, 2)), np.zeros((samples, 5)), np.zeros((samples, 2)))
    truth = replace(unseen(layout, samples), tau_ext=external, contact=np.ones((samples, 2)))
    edges = np.linspace(0, samples, segments + 1).round().astype(int)
    spans = tuple((int(a), int(b)) for a, b in pairwise(edges))
    meta = {"scenario": "made_up", "level": "all_uncertainty", "seed": int(rng.integers(1 << 30))}
    return Recording(sensed, spans, RATE_HZ, meta, truth)


def _sines(time: Array, count: int, rng: np.random.Generator, size: float) -> tuple[Array, Array]:
    """Return a smooth random signal (T, count) and its rate."""
    frequency = 2 * np.pi * rng.uniform(0.3, 2.0, (WAVES, count))
    phase = time[:, None, None] * frequency + rng.uniform(0, 2 * np.pi, (WAVES, count))
    amplitude = size * rng.uniform(0.3, 1.0, (WAVES, count)) / WAVES
    return (amplitude * np.sin(phase)).sum(axis=1), (amplitude * frequency * np.cos(phase)).sum(axis=1)


def _uncertainty(sensed: Sensed, layout: JointLayout) -> Array:
    """Return friction-like torque (T, nv) that velocity and desired torque explain."""
    friction = 0.2 * sensed.tau_des - 8.0 * np.tanh(sensed.v[:, N_VIRTUAL:] / 0.1)
    return np.concatenate([np.zeros((len(sensed), N_VIRTUAL)), friction], axis=1)
