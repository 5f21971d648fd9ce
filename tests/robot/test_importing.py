"""Tables from URDF and MJCF files: equal to what MuJoCo and Pinocchio read, and honest about the rest."""

from functools import partial
from pathlib import Path

import numpy as np
import pytest

from mobnet.core.errors import DataError
from mobnet.robot.description import describe
from mobnet.robot.import_checks import differences
from mobnet.robot.import_table import main, table_text
from mobnet.robot.importing import import_robot
from mobnet.robot.plant import robot_spec
from mobnet.settings.load import load_section
from mobnet.settings.robot import RobotTable

ARM = Path("tests/data/arm.urdf")
EQUAL = 1e-10


def table_of(path, folder, floating=None):
    """Return what is imported and the robot of the table that is written of it."""
    found = import_robot(path, floating, 100.0, 10.0)
    (folder / "table.yaml").write_text(table_text(found, path.name))
    return found, describe(load_section(folder / "table.yaml", RobotTable))


def test_an_arm_is_read_as_mujoco_and_pinocchio_read_it(tmp_path):
    found, robot = table_of(ARM, tmp_path)
    apart = {reading: numbers for reading, *numbers in differences(robot, found, ARM)}
    assert apart.keys() == {"MuJoCo", "Pinocchio"}
    assert np.max(list(apart.values())) < EQUAL
    assert robot.layout.groups == {"limb": ("J1", "J2")}
    assert not robot.floating
    assert robot.bodies[-1].mass == pytest.approx(2.0)  # of the lower link, with tool and finger
    assert (robot.joints[0].torque_limit, robot.joints[0].velocity_limit) == (60.0, 10.0)


def test_what_is_not_in_the_file_or_the_table_is_told(tmp_path):
    notes = "\n".join(table_of(ARM, tmp_path)[0].notes)
    for text in (
        "grip: slides; it is welded at zero", "range of J2: not in the file", "torque of J2: not in the file, 100 N m",
        "damping of joints: not taken over", "armature: zero for all joints", "the base is taken as fixed",
    ):  # fmt: skip
        assert text in notes
    assert "torque of J1" not in notes
    assert "dry friction" not in notes


def test_a_humanoid_from_a_mjcf_file_is_its_own_table(robot, tmp_path):
    """The plant's own model, written as MJCF and read back: every mass, frame and joint."""
    spec = robot_spec(robot)
    spec.compile()
    (tmp_path / "humanoid.xml").write_text(spec.to_xml())
    found, read = table_of(tmp_path / "humanoid.xml", tmp_path)
    assert read.floating
    assert read.layout.actuated == robot.layout.actuated
    assert read.mass == pytest.approx(robot.mass)
    np.testing.assert_allclose(read.armature, robot.armature, rtol=1e-5)  # MJCF is written with six digits
    ((reading, inertia, terms),) = differences(read, found, tmp_path / "humanoid.xml")
    assert reading == "MuJoCo"
    assert max(inertia, terms) < EQUAL
    assert {tuple(joints) for limb, joints in read.layout.groups.items() if limb != "V"} >= {
        robot.layout.limb("LL"), robot.layout.limb("RA")
    }  # fmt: skip
    assert read.imu == robot.imu
    (feet,) = [note for note in found.notes if note.startswith("feet: ")]
    moved = {joint.id: joint.body for joint in robot.joints}  # what is welded below it is one body with it
    for side, foot in robot.feet.items():
        assert f"{side}: {{body: {moved[robot.layout.limb(foot.limb)[-1]]}, limb: " in feet


OFFSET = """<mujoco model="offset"><worldbody><body name="stand"><geom size="0.1"/>
<body name="beam" pos="0 0 0.2"><joint name="swing" axis="0 1 0" pos="0.1 0 0.05" range="-60 60"/>
<inertial pos="0.2 0 0" mass="2" diaginertia="0.01 0.02 0.02"/>
<body name="tip" pos="0.4 0 0" euler="0 0 30"><joint name="turn" axis="1 0 0" pos="0 0.03 0"/>
<inertial pos="0.05 0 0.1" mass="1" fullinertia="0.01 0.012 0.009 0.001 0 0.0005"/></body></body></body></worldbody>
<actuator><motor joint="swing" gear="50" ctrlrange="-2 2"/></actuator></mujoco>"""


def test_joints_away_from_the_origins_of_their_bodies_move_the_frames(tmp_path):
    (tmp_path / "offset.xml").write_text(OFFSET)
    found, robot = table_of(tmp_path / "offset.xml", tmp_path)
    ((_, inertia, terms),) = differences(robot, found, tmp_path / "offset.xml")
    assert max(inertia, terms) < EQUAL
    assert robot.joints[0].torque_limit == 100.0  # 2 behind a gear of 50
    assert robot.joints[0].range == pytest.approx(np.radians([-60, 60]))


def test_the_base_is_what_the_user_says(tmp_path):
    found, robot = table_of(ARM, tmp_path, floating=True)
    assert robot.floating
    assert robot.layout.nv == 8
    apart = {reading: numbers for reading, *numbers in differences(robot, found, ARM)}
    assert apart.keys() == {"MuJoCo", "Pinocchio"}
    assert np.max(list(apart.values())) < EQUAL
    assert robot.mass == pytest.approx(10.0)


def test_rotors_that_no_file_has_are_taken_from_the_user(tmp_path):
    found = import_robot(ARM, None, 100.0, 10.0, armature=0.2)
    (tmp_path / "table.yaml").write_text(table_text(found, ARM.name))
    robot = describe(load_section(tmp_path / "table.yaml", RobotTable))
    assert robot.armature.tolist() == [0.2, 0.2]
    assert "armature of all joints: not in the file, 0.2 kg m^2 is taken" in found.notes
    assert not any(note.startswith("armature: zero") for note in found.notes)
    assert np.max([numbers for _, *numbers in differences(robot, found, ARM)]) < EQUAL


SIDED = """<mujoco model="sided"><worldbody><body name="trunk" pos="0 0 1"><freejoint/>
<inertial pos="0 0 0" mass="5" diaginertia="0.1 0.1 0.1"/>
<site name="imu_tilted" pos="0.1 0 0" euler="0 0 90"/><site name="imu_spare"/>
{limbs}</body></worldbody></mujoco>"""
LIMB = """<body name="{side}_{part}" pos="0 {y} {z}"><joint name="{side}_{joint}_pitch" axis="0 1 0"/>
<inertial pos="0 0 -0.1" mass="1" diaginertia="0.01 0.01 0.01"/><site name="{side}_{part}_imu"/>
<body name="{side}_{part}_end" pos="0 0 -0.2"><joint name="{side}_{end}" axis="0 1 0"/>
<inertial pos="0 0 -0.1" mass="1" diaginertia="0.01 0.01 0.01"/></body></body>"""


def test_limbs_sensors_and_feet_are_told_by_names_and_places(tmp_path):
    parts = [("leg", "hip", "knee", -0.1), ("arm", "shoulder", "elbow", 0.4)]
    limbs = "".join(
        LIMB.format(side=side, part=part, joint=joint, end=end, y=y, z=z)
        for part, joint, end, z in parts
        for side, y in (("left", 0.1), ("right", -0.1))
    )
    (tmp_path / "sided.xml").write_text(SIDED.format(limbs=limbs))
    found, robot = table_of(tmp_path / "sided.xml", tmp_path)
    assert {"leftleg", "rightleg", "leftarm", "rightarm"} < set(robot.layout.groups)
    assert robot.imu is not None
    assert robot.imu.pos == pytest.approx((0.1, 0.0, 0.0))
    notes = "\n".join(found.notes)
    for text in (
        "imu_tilted: its axes are not those of the base", "imu_spare: another inertial sensor on the base",
        "left_leg_imu: an inertial sensor on left_leg; a table has that of the base, trunk",
        "feet: these bodies at the ends of limbs are lowest: {left: {body: left_leg_end, limb: leftleg}",
    ):  # fmt: skip
        assert text in notes
    assert "arm_end" not in notes


@pytest.fixture
def say(saying):
    return partial(saying, main)


def test_the_command_writes_a_table_once_and_says_how_equal_it_is(say, tmp_path):
    out = tmp_path / "arm.yaml"
    status, lines = say(ARM, "--out", out)
    assert status == 0
    assert lines[0] == "two-link arm: 2 joints, 3 bodies, 6 kg, fixed base"
    assert sum("own reading: mass matrix" in line for line in lines) == 2
    before = out.read_text()
    status, lines = say(ARM, "--out", out)
    assert (status, out.read_text()) == (1, before)
    assert "exists already" in lines[0]
    assert say(ARM, "--out", out, "--force")[0] == 0


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("<robot", "unclosed token"),
        ("<robot name='r'><link name='a'/></robot>", "no hinge"),
        ("<mujoco><worldbody><body><joint/></body></worldbody></mujoco>", "no hinge that moves a mass"),
    ],
    ids=["no xml", "no hinge", "no mass"],
)
def test_what_is_no_robot_is_one_line(text, message, say, tmp_path):
    (tmp_path / "odd.urdf").write_text(text)
    status, lines = say(tmp_path / "odd.urdf", "--out", tmp_path / "odd.yaml")
    assert (status, len(lines)) == (1, 1)
    assert message in lines[0]
    with pytest.raises(DataError):
        import_robot(tmp_path / "odd.urdf", None, 1.0, 1.0)


def test_a_word_that_is_no_base_names_both(say, tmp_path):
    status, lines = say(ARM, "--base", "wheels", "--out", tmp_path / "arm.yaml")
    assert (status, lines) == (1, ["--base: 'wheels' is not accepted; accepted: fixed, floating"])


def test_a_file_that_is_not_there_is_one_line(say, tmp_path):
    path = tmp_path / "none.urdf"
    status, lines = say(path, "--base", "fixed", "--out", tmp_path / "table.yaml")
    assert status == 1
    assert lines == [f"{path}: cannot be read: No such file or directory; accepted: a URDF or MJCF file"]
