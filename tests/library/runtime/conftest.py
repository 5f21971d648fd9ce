"""The C library, compiled once, and models of both robots for it."""

from dataclasses import fields

import c_library
import numpy as np
import pytest
from demo_push import NETWORK, DemoPush
from made_notes import network_note

from mobnet.core.joints import N_VIRTUAL, NQ_BASE
from mobnet.core.recording import Sensed
from mobnet.detection.chain import make_chain
from mobnet.estimation.observer import RobotObserver
from mobnet.export.model_file import RuntimeDetector, RuntimeNetwork, write_model_file
from mobnet.learning.deployed.weights import WeightsNote, read_weights, shapes
from mobnet.learning.features import BASE_NAMES
from mobnet.robot.description import describe
from mobnet.robot.nominal import NominalModel

RATE_HZ, GAIN_HZ, GRAVITY = 1000.0, 100.0, 9.8
LOW_PASS_HZ, HOLD_S = 15.0, 0.005
WAVES_HZ = 0.3, 2.0  # slowest and fastest motion of the made-up joints


def pytest_collection_modifyitems(items):
    """Skip what needs a compiler where there is none."""
    if not c_library.HAS_COMPILER:
        for item in items:
            if item.path.is_relative_to(c_library.ROOT / "tests" / "library" / "runtime"):
                item.add_marker(pytest.mark.skip(reason=c_library.REASON))


@pytest.fixture(scope="session")
def built(tmp_path_factory):
    """A folder for what make builds."""
    return tmp_path_factory.mktemp("runtime")


@pytest.fixture(scope="session")
def library(built):
    """The library, compiled with all warnings as errors."""
    return c_library.load(c_library.make("libmobnet.so", built))


@pytest.fixture
def runtime(library, tmp_path):
    """A function of an observer, networks and detectors that sets their model up in the library's memory."""

    def start(observer, networks=(), detectors=()):
        write_model_file(tmp_path / "model.bin", observer, networks, detectors)
        found = c_library.Runtime(library, (tmp_path / "model.bin").read_bytes())
        assert found.status == c_library.OK
        return found

    return start


@pytest.fixture(scope="session")
def observer_of(robot_table, arm_table):
    """A function of `robot` or `arm` and of what its torques are that makes its observer."""

    def make(machine, torque="mean"):
        table = robot_table if machine == "robot" else arm_table
        return RobotObserver(NominalModel(describe(table), 0.9, GRAVITY), GAIN_HZ, RATE_HZ, torque)

    return make


@pytest.fixture(scope="session")
def push(settings, recipe_of):
    """The stored push of docs/demo with the published configuration."""
    return DemoPush(settings, recipe_of)


@pytest.fixture(scope="session")
def felt(push):
    """What the project estimates of the stored push, step by step."""
    return push.estimate("MOB-Net-pushed")


@pytest.fixture(scope="session")
def published(push):
    """The network of the stored push."""
    return RuntimeNetwork(*read_weights(NETWORK / "weights.safetensors"))


def chain_of(thresholds):
    return make_chain(LOW_PASS_HZ, HOLD_S, RATE_HZ, np.asarray(thresholds))


def network_of(layout, limb, cell, seed=0, **changes):
    """Return a network of a limb with random weights, whose inputs are the limb's and, where it floats, the base's."""
    joints = layout.limb(limb)
    known = [joint for joint in joints if joint in layout.actuated] or layout.actuated[:2]
    inputs = [f"{signal}.{joint}" for signal in ("q", "v", "tau_des") for joint in known]
    inputs += BASE_NAMES if layout.virtual else ()
    note = WeightsNote.model_validate(network_note(limb, joints, inputs, cell, std_min=1e-3))
    rng = np.random.default_rng(seed)
    tensors = {name: rng.normal(0.0, 0.3, shape) for name, shape in shapes(note.cell, len(inputs), len(joints)).items()}
    tensors |= {name: np.exp(tensors[name]) for name in ("input.std", "target.std", "std.scale")}
    return RuntimeNetwork({name: tensor.astype(np.float32) for name, tensor in tensors.items()}, note, **changes)


def moving(layout, samples, seed=0):
    """Return what a robot senses (T, ...) whose joints move smoothly within their limits, the base too."""
    rng, nu, base = np.random.default_rng(seed), layout.nu, len(layout.virtual)
    time = np.arange(samples)[:, None] / RATE_HZ
    waves = 2.0 * np.pi * rng.uniform(*WAVES_HZ, nu), rng.uniform(0.0, 6.0, nu)
    q, v = np.zeros((samples, layout.nq)), np.zeros((samples, layout.nv))
    q[:, layout.nq - nu :], v[:, base:] = np.sin(time * waves[0] + waves[1]), np.cos(time * waves[0] + waves[1])
    q[:, layout.nq - nu :] *= [0.9 * min(-layout.limits[j].low, layout.limits[j].high, 1.0) for j in layout.actuated]
    if base:
        q[:, 3:NQ_BASE] = np.concatenate(
            [np.ones_like(time), 0.1 * np.sin(time), 0.2 * np.cos(time), time / 20], axis=1
        )
        q[:, 3:NQ_BASE] /= np.linalg.norm(q[:, 3:NQ_BASE], axis=1, keepdims=True)
        v[:, :N_VIRTUAL] = 0.3 * np.sin(time * rng.uniform(1.0, 9.0, N_VIRTUAL))
    feet, torque = np.zeros((samples, len(layout.legs))), 10.0 * np.sin(3.0 * time + np.arange(nu))
    acc = 9.8 + np.sin(time + np.arange(3.0 if base else 0.0))
    command = np.zeros((samples, 5 if layout.legs else 0))
    return Sensed(q, v, acc, torque[:, ::-1], torque, feet, command, feet)


def changed(sample, **parts):
    """Return a copy of samples in which some parts are others."""
    return Sensed(**{field.name: parts.get(field.name, getattr(sample, field.name)) for field in fields(sample)})


def watching(layout, limb, signals=("mean",), threshold=5.0, **changes):
    """Return a detector of a limb."""
    joints = layout.limb(limb)
    return RuntimeDetector(
        limb, joints, signals, chain_of(np.full((1, len(signals) * len(joints)), threshold)), **changes
    )
