"""Tables from URDF and MJCF files: equal to what MuJoCo and Pinocchio read, and honest about the rest."""

import dataclasses
import os
from functools import partial
from pathlib import Path

import numpy as np
import pinocchio as pin
import pytest

from mobnet.core.errors import DataError
from mobnet.formats.loading import load_section
from mobnet.formats.robot import RobotTable
from mobnet.robot import import_checks, import_table
from mobnet.robot.description import describe
from mobnet.robot.import_checks import _apart, differences
from mobnet.robot.import_file import read_file
from mobnet.robot.import_inertia import balanced, is_rigid
from mobnet.robot.import_mjcf import BOUND_INERTIA, BOUND_MASS, spec_of
from mobnet.robot.import_rows import MOST_RAD, _range
from mobnet.robot.import_table import main, robot_of_text, table_text
from mobnet.robot.import_tree import Joint
from mobnet.robot.importing import import_robot
from mobnet.robot.plant import robot_spec

ARM = Path("tests/data/arm.urdf")
EQUAL = 1e-10


def table_of(path, folder, floating=None):
    """Return what is imported and the robot of the table that is written of it."""
    found = import_robot(path, floating, 100.0, 10.0)
    (folder / "table.yaml").write_text(table_text(found, path.name))
    return found, describe(load_section(folder / "table.yaml", RobotTable))


def test_an_arm_is_read_as_mujoco_and_pinocchio_read_it(tmp_path):
    found, robot = table_of(ARM, tmp_path)
    apart = {reading: numbers for reading, *numbers in differences(robot, found)}
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
    ((reading, inertia, terms),) = differences(read, found)
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
    ((_, inertia, terms),) = differences(robot, found)
    assert max(inertia, terms) < EQUAL
    assert robot.joints[0].torque_limit == 100.0  # 2 behind a gear of 50
    assert robot.joints[0].range == pytest.approx(np.radians([-60, 60]))


def test_the_base_is_what_the_user_says(tmp_path):
    found, robot = table_of(ARM, tmp_path, floating=True)
    assert robot.floating
    assert robot.layout.nv == 8
    apart = {reading: numbers for reading, *numbers in differences(robot, found)}
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
    assert np.max([numbers for _, *numbers in differences(robot, found)]) < EQUAL


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


def arm_with(*changes):
    """Return the arm's URDF with words replaced."""
    text = ARM.read_text()
    for old, new in changes:
        assert old in text
        text = text.replace(old, new)
    return text


HINGE = "<body><joint/><geom size='.1' pos='.1 0 0'/></body>"
ROBOT = f"<body name='{{name}}'><freejoint/><geom size='.1'/>{HINGE}</body>"
HOSTILE = {
    "effort of no number": (arm_with(('effort="60"', 'effort="abc"')), "joint J1: effort 'abc' is not accepted"),
    "effort below zero": (arm_with(('effort="60"', 'effort="-5"')), "joint J1: effort -5 N m is not accepted"),
    "a joint twice": (arm_with(('name="J2"', 'name="J1"')), "two joints named 'J1' are not accepted"),
    "a link twice": (arm_with(('link name="tool"', 'link name="upper"')), "two links named 'upper' are not accepted"),
    "a link that is not there": (
        arm_with(('child link="upper"', 'child link="uper"')),
        "child: 'uper' is not accepted",
    ),
    "another type": (
        arm_with(('type="revolute"', 'type="hinge"')),
        "type: 'hinge' is not accepted; accepted: continuous",
    ),
    "no direction": (arm_with(('axis xyz="0 1 0"', 'axis xyz="0 0 0"')), "axis [0.0, 0.0, 0.0] is not accepted"),
    "two numbers": (arm_with(('xyz="0.1 0 0"', 'xyz="0.1 0"')), "xyz '0.1 0' is not accepted; accepted: three numbers"),
    "mass of no number": (arm_with(('mass value="3.0"', 'mass value="nan"')), "mass 'nan' is not accepted"),
    "mass below zero": (arm_with(('mass value="3.0"', 'mass value="-3"')), "mass -3 kg is not accepted"),
    "a loop": (
        arm_with(
            ("</robot>", "<joint name='z' type='fixed'><parent link='finger'/><child link='wall'/></joint></robot>")
        ),
        "no root (a loop of links) is not accepted",
    ),
    "two parents": (
        arm_with(
            ("</robot>", "<joint name='z' type='fixed'><parent link='wall'/><child link='tool'/></joint></robot>")
        ),
        "link tool below two joints, flange and z, is not accepted",
    ),
    "xacro without its namespace": (
        arm_with(("<link name='wall'>".replace("'", '"'), '<xacro:include/><link name="wall">')),
        "xacro:include is not accepted; accepted: a URDF, made of xacro by: xacro ",
    ),
    "no element": ("", "no element found"),
    "sdf": (
        "<sdf><model name='x'/></sdf>",
        "first element: 'sdf' is not accepted; accepted: MJCF (mujoco), URDF (robot)",
    ),
    "an empty MJCF": ("<mujoco/>", "no hinge that moves a mass"),
    "nested": ("<robot>" + 10000 * "<a>" + 10000 * "</a>" + "</robot>", "more than 500 elements in each other"),
    "entities": (
        "<!DOCTYPE r [<!ENTITY a '" + 100 * "a" + "'><!ENTITY b '" + 100 * "&a;" + "'><!ENTITY c '" + 100 * "&b;" + "'>"
        "<!ENTITY d '" + 100 * "&c;" + "'>]><robot name='r'>&d;</robot>",
        "limit on input amplification",
    ),
    "a file that includes itself": ("<mujoco><include file='odd.urdf'/></mujoco>", "already included"),
    "two robots": (
        f"<mujoco><worldbody>{ROBOT.format(name='a')}{ROBOT.format(name='b')}</worldbody></mujoco>",
        "2 bases that float (a and b) are not accepted; accepted: one, or --base fixed",
    ),
    "a mass from a mesh that is missing": (
        "<mujoco><asset><mesh name='m' file='no.stl'/></asset><worldbody><body name='b'><joint/>"
        "<geom type='mesh' mesh='m'/></body></worldbody></mujoco>",
        "or an <inertial> of the bodies whose masses follow from meshes: ['b']",
    ),
    "too many": (f"<mujoco><worldbody>{251 * HINGE}</worldbody></mujoco>", "251 hinges are not accepted"),
}


@pytest.mark.parametrize(("text", "message"), HOSTILE.values(), ids=HOSTILE)
def test_a_file_that_is_wrong_is_one_line_and_leaves_the_table_as_it_was(text, message, say, tmp_path):
    (tmp_path / "odd.urdf").write_text(text)
    (tmp_path / "odd.yaml").write_text("a good table")
    status, lines = say(tmp_path / "odd.urdf", "--out", tmp_path / "odd.yaml", "--force")
    assert (status, len(lines)) == (1, 1)
    assert lines[0].startswith(f"{tmp_path / 'odd.urdf'}: ")
    assert message in lines[0]
    assert (tmp_path / "odd.yaml").read_text() == "a good table"


def test_what_is_no_file_or_too_large_is_one_line(say, tmp_path):
    os.mkfifo(tmp_path / "pipe.urdf")
    (tmp_path / "device.urdf").symlink_to("/dev/zero")
    with (tmp_path / "large.urdf").open("wb") as file:
        file.truncate(2**36)
    texts = {
        "pipe": "a pipe or a device is not",
        "device": "a pipe or a device is not",
        "large": "more than 64 MiB are",
    }
    for name, text in texts.items():
        status, lines = say(tmp_path / f"{name}.urdf", "--out", tmp_path / "table.yaml")
        assert (status, len(lines)) == (1, 1)
        assert text in lines[0]


def test_a_file_that_ends_mujoco_is_one_line(say, tmp_path):
    (tmp_path / "self.xml").write_text(
        f"<mujoco><asset><model name='m' file='self.xml'/></asset><worldbody>{HINGE}</worldbody></mujoco>"
    )
    status, lines = say(tmp_path / "self.xml", "--out", tmp_path / "table.yaml")
    assert (status, len(lines)) == (1, 1)
    assert "reading it ended by signal SIGSEGV" in lines[0]
    assert not (tmp_path / "table.yaml").exists()


def test_a_check_that_cannot_run_is_a_note(say, tmp_path, monkeypatch):
    def refuse(*_):
        raise ValueError("no\nmodel; accepted: another")

    monkeypatch.setattr(import_checks, "_pinocchio", refuse)
    status, lines = say(ARM, "--out", tmp_path / "arm.yaml")
    assert status == 0
    assert "note: not compared with Pinocchio's own reading: no model" in lines
    assert sum("own reading: mass matrix" in line for line in lines) == 1


def test_a_table_that_differs_from_another_reading_is_not_written(say, tmp_path, monkeypatch):
    monkeypatch.setattr(import_table, "differences", lambda *_: [("Pinocchio", 2e-6, 0.0)])
    status, lines = say(ARM, "--out", tmp_path / "arm.yaml")
    assert (status, len(lines)) == (1, 1)
    assert "the table differs from Pinocchio's own reading by 2.0e-06 of the largest entries" in lines[0]
    assert not (tmp_path / "arm.yaml").exists()


def test_a_wrong_place_is_seen_by_the_check(tmp_path):
    found, robot = table_of(ARM, tmp_path)
    moved = robot.bodies[2].model_copy(update={"pos": (0.451, 0.0, 0.0)})
    other = dataclasses.replace(robot, bodies=(*robot.bodies[:2], moved))
    assert all(max(apart) > 1e-6 for _, *apart in differences(other, found))


def test_words_of_yaml_and_marks_in_names_are_quoted(say, tmp_path):
    text = arm_with(('"J1"', '"no"'), ('"J2"', '"a: {b}, #c&#10;d"'), ('"upper"', '"null"'), ("two-link arm", "123"))
    (tmp_path / "odd.urdf").write_text(text)
    assert say(tmp_path / "odd.urdf", "--out", tmp_path / "odd.yaml")[0] == 0
    table = load_section(tmp_path / "odd.yaml", RobotTable)
    assert table.name == "123"
    assert [(joint.id, joint.name) for joint in table.joints] == [("no", "no"), ("a___b____c_d", "a: {b}, #c\nd")]
    assert table.bodies[1].name == "null"


def test_a_mjcf_needs_no_files_of_what_has_no_mass(tmp_path):
    (tmp_path / "scene.xml").write_text(
        "<mujoco><asset><mesh file='no/hand.obj' scale='2 2 2'/><texture name='t' type='2d' file='no.png'/>"
        "<texture name='s' type='skybox' file='no.png'/><material name='m' texture='t'/>"
        "<hfield name='h' file='no.png' size='1 1 1 1'/><skin name='s' file='no.skn'/></asset>"
        "<worldbody><geom type='hfield' hfield='h'/><body name='arm'><joint name='swing' axis='0 1 0'/>"
        "<inertial pos='0.1 0 0' mass='1' diaginertia='0.01 0.01 0.01'/>"
        "<geom type='mesh' mesh='hand' material='m'/></body></worldbody></mujoco>"
    )
    found, robot = table_of(tmp_path / "scene.xml", tmp_path)
    ((_, inertia, terms),) = differences(robot, found)
    assert max(inertia, terms) < EQUAL


def test_the_robot_of_a_scene_is_what_has_most_joints(tmp_path):
    two = "<body><joint/><geom size='.1' pos='.1 0 0'/>" + HINGE + "</body>"
    scissors = ROBOT.format(name="scissors")
    (tmp_path / "arm.xml").write_text(f"<mujoco><worldbody>{scissors}{two}</worldbody></mujoco>")
    found, robot = table_of(tmp_path / "arm.xml", tmp_path)
    assert (robot.floating, len(robot.joints)) == (False, 2)
    assert "left out, as no part of the robot: scissors, a body without a name" in found.notes
    walker = f"<body name='trunk'><freejoint/><geom size='.1'/>{two}</body>"
    (tmp_path / "walker.xml").write_text(f"<mujoco><worldbody>{HINGE}{walker}</worldbody></mujoco>")
    found, robot = table_of(tmp_path / "walker.xml", tmp_path)
    assert (robot.floating, robot.base, len(robot.joints)) == (True, "trunk", 2)
    ((_, inertia, terms),) = differences(robot, found)
    assert max(inertia, terms) < EQUAL


def test_a_macro_that_xacro_left_in_a_whole_robot_is_noted(tmp_path):
    space = ('name="two-link arm"', 'name="two-link arm" xmlns:xacro="http://ros.org/wiki/xacro"')
    (tmp_path / "left.urdf").write_text(arm_with(space, ("</robot>", "<xacro:sensors port='1'/></robot>")))
    assert (
        "macros of xacro that are not expanded are left out: sensors"
        in table_of(tmp_path / "left.urdf", tmp_path)[0].notes
    )
    (tmp_path / "whole.urdf").write_text(arm_with(space, ("</robot>", "<xacro:include filename='x'/></robot>")))
    with pytest.raises(DataError, match="xacro:include is not accepted; accepted: a URDF, made of xacro by: xacro "):
        table_of(tmp_path / "whole.urdf", tmp_path)


def test_a_joint_of_a_mjcf_that_follows_another_one_is_welded(tmp_path):
    (tmp_path / "hand.xml").write_text(
        "<mujoco><compiler angle='radian'/><worldbody>"
        "<body name='a'><joint name='lead' axis='0 1 0' ref='0.2'/><geom size='.1' pos='.1 0 0'/></body>"
        "<body name='b'><joint name='tail' axis='0 1 0' ref='-0.1'/><geom size='.1' pos='.1 0 0'/>"
        "<body name='c'><joint name='tip' axis='0 1 0'/><geom size='.1' pos='.2 0 0'/></body></body></worldbody>"
        "<equality><joint joint1='tail' joint2='lead' polycoef='0.05 -2 0 0 0'/></equality>"
        "<actuator><motor joint='lead'/></actuator></mujoco>"
    )
    found, robot = table_of(tmp_path / "hand.xml", tmp_path)
    ((_, inertia, terms),) = differences(robot, found)
    assert max(inertia, terms) < EQUAL
    assert robot.layout.actuated == ("lead", "tip")
    (tail,) = found.robot.held.values()
    assert tail == pytest.approx(-0.1 + 0.05 - 2.0 * (0.0 - 0.2))
    assert "no motor in the file: tip; --lock welds what a log does not have" in found.notes


def test_a_token_without_a_place_among_masses_is_left_out(tmp_path):
    """A camera of a gram with the inertia of a wheel: the link that carries it would have no body's inertia."""
    camera = (
        "<link name='camera'><inertial><mass value='1e-6'/><inertia ixx='0' iyy='0' izz='5' ixy='0' ixz='0' iyz='0'/>"
        "</inertial></link>"
        "<joint name='mount' type='fixed'><parent link='lower'/><child link='camera'/></joint></robot>"
    )
    (tmp_path / "token.urdf").write_text(arm_with(("</robot>", camera)))
    found, robot = table_of(tmp_path / "token.urdf", tmp_path)
    assert any(note.startswith("camera: 1e-06 kg with") and note.endswith("left out") for note in found.notes)
    apart = {reading: numbers for reading, *numbers in differences(robot, found)}
    assert max(apart["Pinocchio"]) < EQUAL
    assert robot.bodies == table_of(ARM, tmp_path)[1].bodies


def test_a_light_link_with_the_inertia_of_a_heavy_one_gets_mass_and_a_heavy_one_is_refused(tmp_path):
    mass, inertia = balanced(1e-6, 0.1 * np.eye(3))
    assert is_rigid(mass, inertia)
    np.testing.assert_allclose(inertia, 0.1 * np.eye(3))
    (tmp_path / "unit.urdf").write_text(arm_with(('ixx="0.004" iyy="0.05" izz="0.05"', 'ixx="40" iyy="500" izz="500"')))
    with pytest.raises(DataError, match=r"radius of gyration of 12\.9 m is not accepted"):
        robot_of_text(table_text(import_robot(tmp_path / "unit.urdf", None, 1.0, 1.0), "x"), tmp_path / "unit.urdf")
    (tmp_path / "large.urdf").write_text(arm_with(('ixx="0.004" iyy="0.05" izz="0.05"', 'ixx="8" iyy="8" izz="8"')))
    notes = table_of(tmp_path / "large.urdf", tmp_path)[0].notes
    assert any(note.startswith("upper: 3 kg with") and "a radius of gyration of 1.63 m" in note for note in notes)


@pytest.mark.parametrize(
    ("moments", "possible"),
    [
        ((1e-3, 1e-3, 1e-2), (1e-3, 1e-3, 2e-3)),
        ((3e-3, 4e-3, 4.8), (3e-3, 4e-3, 7e-3)),
        ((-1e-3, 1e-2, 1e-2), (1e-6, 1e-2, 1e-2)),
        ((0.0, 0.0, 0.0), (1e-6, 1e-6, 1e-6)),
        ((1e-9, 1e-9, 1e-9), (1e-6, 1e-6, 1e-6)),
    ],
)
def test_moments_that_no_body_has_become_possible_about_the_same_axes(moments, possible):
    turn = pin.exp3(np.array([0.3, -0.5, 0.7]))
    inertia = turn @ np.diag(moments) @ turn.T
    assert not is_rigid(1.0, inertia)
    mass, found = balanced(1.0, inertia)
    assert mass == 1.0
    assert is_rigid(mass, found)
    np.testing.assert_allclose(np.diag(turn.T @ found @ turn), possible, rtol=2e-3)


def test_a_word_that_is_no_base_names_both(say, tmp_path):
    status, lines = say(ARM, "--base", "wheels", "--out", tmp_path / "arm.yaml")
    assert (status, lines) == (1, ["--base: 'wheels' is not accepted; accepted: fixed, floating"])


def test_a_file_that_is_not_there_is_one_line(say, tmp_path):
    path = tmp_path / "none.urdf"
    status, lines = say(path, "--base", "fixed", "--out", tmp_path / "table.yaml")
    assert status == 1
    assert lines == [f"{path}: cannot be read: No such file or directory; accepted: a URDF or MJCF file"]


def test_a_table_that_is_refused_replaces_none(saying, tmp_path):
    (tmp_path / "bad.urdf").write_text(ARM.read_text().replace('effort="60"', 'effort="-5"'))
    old, words = tmp_path / "good.yaml", (tmp_path / "bad.urdf", "--out")
    assert saying(main, ARM, "--out", old)[0] == 0
    before = old.read_bytes()
    for out in (old, tmp_path / "new.yaml"):
        status, (line,) = saying(main, *words, out, "--force")
        assert status == 1
        assert line.startswith(f"{tmp_path / 'bad.urdf'}: joint J1: effort -5 N m is not accepted; accepted: above 0")
    assert old.read_bytes() == before
    assert {path.name for path in tmp_path.iterdir()} == {"bad.urdf", "good.yaml"}
    assert saying(main, ARM, "--out", tmp_path / "new.yaml")[0] == 0


@pytest.mark.parametrize("name", ["a, b", "{b", "a: b", "a#b", "[", "&quot;a&quot;", "line&#10;name: other", "yes"])
def test_names_that_yaml_would_take_apart_are_quoted(name, tmp_path):
    (tmp_path / "odd.urdf").write_text(ARM.read_text().replace('"J2"', f'"{name}"'))
    found, robot = table_of(tmp_path / "odd.urdf", tmp_path)
    assert robot.name == "two-link arm"
    assert robot.joints[1].name == found.joints[1]["name"] != "J2"


def test_a_range_beyond_what_a_table_takes_is_cut_at_both_ends():
    def range_of(low, high):
        return _range(Joint("j", "hinge", np.eye(3)[2], 0, range=(low, high)))

    assert range_of(-1.0, 2.0) == (-1.0, 2.0)
    assert range_of(-1e3, 2.0) == (-MOST_RAD, 2.0)
    assert range_of(-1.0, 1e3) == (-1.0, MOST_RAD)
    assert range_of(-1e3, 1e3) == (-MOST_RAD, MOST_RAD)


def test_masses_that_a_file_bounds_itself_keep_its_bounds(tmp_path):
    text = "<mujoco>{}<worldbody><body><geom size='.1'/></body></worldbody></mujoco>"
    for compiler, least in (("", (BOUND_MASS, BOUND_INERTIA)), ("<compiler boundmass='2' boundinertia='3'/>", (2, 3))):
        (tmp_path / "ball.xml").write_text(text.format(compiler))
        bounds = spec_of(read_file(tmp_path / "ball.xml")).compiler
        assert (bounds.boundmass, bounds.boundinertia) == least


def test_readings_that_differ_where_one_has_nothing_are_told_apart_by_a_least_size():
    assert _apart(np.full((2, 2), 1e-3), np.zeros((2, 2)), 2.0) == pytest.approx(5e-4)
    assert _apart(np.full((2, 2), 11.0), np.full((2, 2), 10.0), 2.0) == pytest.approx(0.1)
