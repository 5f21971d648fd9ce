"""The commands of docs/real_arm.md run as they stand, on the public logs or, where nobody has them, on a stand-in."""

import re
import shlex
from pathlib import Path

import numpy as np
import pinocchio as pin
import pytest
from made_ur10e import UR10E

from experiments.commands.words import parse
from mobnet.detection.calibrate import main as calibrate
from mobnet.robot.import_table import main as robot
from mobnet.robotlog.detect import main as detect
from mobnet.robotlog.identify import main as identify
from mobnet.robotlog.learn import main as learn
from mobnet.robotlog.observe import main as observe

pytestmark = pytest.mark.slow
PAGE = (Path(__file__).parents[3] / "docs" / "real_arm.md").read_text()
COMMANDS = re.findall(r"^ {4}\./reproduce (.*)$", PAGE, re.MULTILINE)
MAP = re.search(r"```yaml\n(.*?)```", PAGE, re.DOTALL)[1]
MEASURED = PAGE.partition("## Learn")[0]  # what follows depends on a training
PRINTED = [block.splitlines() for block in re.findall(r"```text\n(.*?)```", MEASURED, re.DOTALL)]
NUMBER = re.compile(r"-?\d+(?:\.\d+)?")
CLOSE = 0.02  # numbers of another processor [share]
MAINS = {
    "robot": robot,
    "observe": observe,
    "identify": identify,
    "calibrate": calibrate,
    "detect": detect,
    "learn": learn,
}
PLACE = "dynamic_calibration"
JOINTS = (
    ("shoulder_pan", "z"),
    ("shoulder_lift", "y"),
    ("elbow", "y"),
    ("wrist_1", "y"),
    ("wrist_2", "z"),
    ("wrist_3", "y"),
)
RATE_HZ, SECONDS, COLUMNS, WAVES = 94.0, 36.0, 31, 4
GAINS = (14.87, 13.26, 11.13, 10.62, 11.03, 11.47)  # those of the page [N m/A]
FRICTION, ROTOR = 0.2, 0.05  # of a joint, as shares of its drive's gain [N m], [kg m^2]


def test_the_page_has_every_command():
    assert {line.split()[0] for line in COMMANDS} == set(MAINS)


def made_description():
    """Return a URDF of six links that turn one after another."""
    links, joints = ['<link name="base"/>'], []
    for k, (name, axis) in enumerate(JOINTS):
        mass = 8.0 - k
        inertia = f'<inertia ixx="{0.02 * mass}" iyy="{0.02 * mass}" izz="{0.01 * mass}" ixy="0" ixz="0" iyz="0"/>'
        body = f'<inertial><origin xyz="0.02 0 0.15"/><mass value="{mass}"/>{inertia}</inertial>'
        links.append(f'<link name="{name}">{body}</link>')
        parent = JOINTS[k - 1][0] if k else "base"
        joints.append(
            f'<joint name="{name}_joint" type="revolute"><parent link="{parent}"/><child link="{name}"/>'
            f'<origin xyz="0 0 0.3"/><axis xyz="{int(axis == "x")} {int(axis == "y")} {int(axis == "z")}"/>'
            '<limit lower="-6" upper="6" effort="300" velocity="3"/></joint>'
        )
    return f'<robot name="ur10e">{"".join(links)}{"".join(joints)}</robot>'


def write_log(path, model, seed, moves):
    """Write a made-up log of an arm with friction and rotors that moves, or stands and is pushed at its lift."""
    rng, t = np.random.default_rng(seed), np.arange(0, SECONDS, 1 / RATE_HZ)
    joints = len(JOINTS)
    rate = 2 * np.pi * rng.uniform(0.05, 0.4, (WAVES, 1, joints))
    size = rng.uniform(0.1, 0.25, (WAVES, 1, joints)) * moves
    angle = rate * t[:, None] + rng.uniform(0, 6, (WAVES, 1, joints))
    q, v = (size * np.sin(angle)).sum(axis=0), (size * rate * np.cos(angle)).sum(axis=0)
    a = -(size * np.square(rate) * np.sin(angle)).sum(axis=0)
    data, drives = model.createData(), np.array(GAINS)
    tau = np.array([pin.rnea(model, data, *row) for row in zip(q, v, a, strict=True)])
    tau += drives * (FRICTION * np.tanh(v / 0.01) + FRICTION * v + ROTOR * a)
    if not moves:
        tau[round(10 * RATE_HZ) : round(11 * RATE_HZ), 1] += 3 * drives[1]
    read = [t[:, None], q, v + 2e-4 * rng.normal(size=v.shape), tau / drives + 0.02 * rng.normal(size=tau.shape)]
    rows = np.hstack(read)
    path.parent.mkdir(parents=True, exist_ok=True)
    np.savetxt(path, np.pad(rows, ((0, 0), (0, COLUMNS - rows.shape[1]))), "%.6f", ",")


@pytest.fixture
def place(tmp_path, monkeypatch):
    """The folder in which the page's commands run: with the map, and with the logs or their stand-in."""
    monkeypatch.chdir(tmp_path)
    Path("map.yaml").write_text(MAP)
    if UR10E is not None:
        Path(PLACE).symlink_to(Path(UR10E).absolute())
        return tmp_path
    description = Path(PLACE) / "URe" / "urdf" / "ur10e.urdf"
    description.parent.mkdir(parents=True)
    description.write_text(made_description())
    model = pin.buildModelFromUrdf(str(description))
    for seed, name in enumerate(sorted(set(re.findall(rf"{PLACE}/\S+\.csv", PAGE)))):
        write_log(Path(name), model, seed, moves="push" not in name)
    return tmp_path


def test_the_commands_of_the_page_run_and_print_what_it_shows(place, saying):
    said = []
    for line in COMMANDS:
        words = parse(shlex.split(line))
        short = ["--epochs", "1"] if words.command == "learn" and UR10E is None else []
        status, lines = saying(MAINS[words.command], *words.extra, *short)
        assert status == 0, lines
        said += [part for text in lines for part in text.splitlines()]
    if UR10E is None:
        assert sum("shoulder_lift_joint at" in line for line in said) == 2
        return
    for line in (line for block in PRINTED for line in block):
        wanted = np.array(NUMBER.findall(line), dtype=float)
        alike = [text for text in said if NUMBER.sub("#", text) == NUMBER.sub("#", line)]
        found = [np.array(NUMBER.findall(text), dtype=float) for text in alike]
        assert any(np.allclose(one, wanted, rtol=CLOSE) for one in found), line
