"""Small files of robots, each with a quirk that public files have: read as Pinocchio or MuJoCo reads it, or refused."""

from pathlib import Path

import numpy as np
import pytest

from mobnet.core.errors import DataError
from mobnet.robot.dynamics import gravity, mass_matrix, momentum_and_beta
from mobnet.robot.import_checks import differences
from mobnet.robot.import_table import robot_of_text, table_text
from mobnet.robot.importing import import_robot
from mobnet.robot.nominal import NominalModel

CASES = Path(__file__).parent / "cases"
EQUAL = 1e-10
# file, base -> what its notes say; all others of a kind say nothing of it
NOTES = {
    ("r00_plain.urdf", None): ["the base is taken as fixed"],
    ("r01_link_and_joint_share_name.urdf", None): [],
    ("r03_token_inertia_on_base.urdf", None): [],
    ("r03_token_inertia_on_base.urdf", "floating"): [],
    ("r03b_token_inertia_on_sensor.urdf", None): [],
    ("r04_inertia_not_of_a_body.urdf", None): [
        "lower: 1 kg with the principal moments 0.001, 0.001, 0.01 kg m^2 of no rigid body; changed to 1 kg with the "
        "principal moments 0.001, 0.001, 0.002 kg m^2"
    ],
    ("r04b_inertia_not_of_a_body_fixed.urdf", None): [],
    ("r05_massless_virtual_links.urdf", None): ["no mass in the file: virtual; 1e-12 kg is taken"],
    ("r05_massless_virtual_links.urdf", "floating"): ["no mass in the file: virtual"],
    ("r05b_zero_inertia_link_with_mass.urdf", None): [
        "ankle: 0.27 kg with the principal moments", "of no rigid body; changed to 0.27 kg with the principal"
    ],
    ("r06_limits_that_mean_none.urdf", None): [
        "torque of shoulder: not in the file or not within 0.001 to 5000, 100 N m is taken",
        "speed of shoulder: not in the file or not within 0.1 to 100, 10 rad/s is taken",
    ],
    ("r07_link_longer_than_1_5_m.urdf", None): [],
    ("r08_one_joint.urdf", None): [],
    ("r10_limit_effort_word.urdf", None): ["torque of shoulder: not in the file or not within 0.001 to 5000"],
    ("r11_bom.urdf", None): [],
    ("r12_latin1.urdf", None): [],
    ("r13_world_then_moving_dash.urdf", None): [],
    ("r14_gripper_mimic.urdf", None): ["finger_mimic: follows finger_joint; it is welded at 0 rad"],
    ("r15_planar_base.urdf", None): ["base_move: moves in a plane; it is welded at zero"],
    ("r15_planar_base.urdf", "floating"): ["base_move: moves in a plane; it is welded at zero"],
    ("r16_floating_base_joint.urdf", None): [
        "the base is taken as floating", "left out, as no part of the robot: world"
    ],
    ("r16_floating_base_joint.urdf", "fixed"): ["base_move: moves freely; it is welded at zero"],
    ("r17_two_arms_on_world.urdf", None): [],
    ("r18_names_equal_after_cleaning.urdf", None): [
        "names of bodies: in the file a_b_2 is 'a.b'", "names of joints: in the file j_1_2 is 'j.1'"
    ],
    ("r19_names_of_joints_in_chinese.urdf", None): ["body_1 is '上臂'", "joint_0 is '肩', joint_1 is '肘'"],
    ("r20_effort_missing_with_transmission.urdf", None): ["torque of shoulder: not in the file, 100 N m is taken"],
    ("r21_continuous.urdf", None): ["range of shoulder: not in the file, 12.6 rad is taken"],
    ("r23_axis_not_unit.urdf", None): [],
    ("r25_name_with_dot_and_number.urdf", None): ["b_1_link is '1.link'"],
    ("r28_mounted_upside_down.urdf", None): [],
    ("m00_plain.xml", None): [],
    ("m00_plain.xml", "floating"): [],
    ("m01_unnamed_bodies.xml", None): ["body_1 is without a name"],
    ("m02_first_body_has_dash.xml", None): [],
    ("m03_gripper_slide_with_actuator_equality_tendon_key.xml", None): ["f1: slides; it is welded at zero"],
    ("m03b_slide_with_motor.xml", None): ["lift: slides; it is welded at zero"],
    ("m03c_slide_with_keyframe.xml", None): ["f1: slides; it is welded at zero"],
    ("m03d_slide_with_equality.xml", None): ["f2: slides; it is welded at zero"],
    ("m04_ref.xml", None): [],
    ("m05_free_cube_beside_arm.xml", None): ["left out, as no part of the robot: cube"],
    ("m05_free_cube_beside_arm.xml", "floating"): ["left out, as no part of the robot: cube"],
    ("m06_table_before_arm.xml", None): [],
    ("m06b_cube_before_arm.xml", None): ["left out, as no part of the robot: cube"],
    ("m06b_cube_before_arm.xml", "floating"): ["left out, as no part of the robot: cube"],
    ("m07_two_hinges_on_one_body.xml", None): [],
    ("m08_robot_word_in_comment.xml", None): [],
    ("m09_keyframe_and_base_fixed.xml", None): [],
    ("m09_keyframe_and_base_fixed.xml", "fixed"): ["root: moves freely; it is welded at zero"],
    ("m10_mesh_missing_inertia_given.xml", None): [],
    ("m11_wrist_frame_without_mass.xml", None): ["no mass in the file: virtual"],
    ("m12_unnamed_joints.xml", None): ["joint_0 is without a name, joint_1 is without a name"],
    ("m13_include.xml", None): [],
    ("m15_gravcomp_and_armature.xml", None): ["damping of joints: not taken over", "dry friction of joints: not taken"],
    ("m16_gravity_not_down.xml", None): ["gravity of the file, [0, -9.81, 0] m/s^2, is not taken over"],
    ("m17_position_actuator_on_gear.xml", None): [],
    ("m18_motor_with_force_and_control_range.xml", None): [],
}  # fmt: skip
REFUSED = {
    ("r02_empty_robot.urdf", None): "no link is not accepted; accepted: a URDF with links; of xacro, made by: xacro ",
    ("r09_limit_is_xacro.urdf", None): "'${-pi}' is not accepted; accepted: a URDF, made of xacro by: xacro ",
    ("r26.urdf.xacro", None): "r26.urdf.xacro > r26.urdf",
    ("r17_two_arms_on_world.urdf", "floating"): "a base that floats without mass, world, is not accepted",
    ("r22_no_inertial_anywhere.urdf", None): "no hinge that moves a mass",
    ("r24_two_roots.urdf", None): "2 roots (base, table) is not accepted",
    ("m02_first_body_has_dash.xml", "floating"): "joints that move the base, shoulder, are not accepted",
    ("m14_replicate_or_composite.xml", None): "unrecognized element Element 'composite', line 5",
}
CHANGES = ("of no rigid body", "no mass in the file", "left out", "welded", "gravity of the file")
BASES = {None: None, "fixed": False, "floating": True}


def found_of(name, base=None, locked=()):
    """Return what is imported and the robot of its table."""
    found = import_robot(CASES / name, BASES[base], 100.0, 10.0, locked=locked)
    return found, robot_of_text(table_text(found, name), CASES / name)


def test_every_case_is_here():
    assert {name for name, _ in (*NOTES, *REFUSED)} == {path.name for path in CASES.iterdir()}


@pytest.mark.parametrize(("name", "base"), NOTES, ids=lambda word: str(word).partition("_")[0])
def test_a_quirk_is_read_as_the_file_s_own_library_reads_it_and_told(name, base):
    found, robot = found_of(name, base)
    compared = list(differences(robot, found))
    assert ("Pinocchio" if name.startswith("r") else "MuJoCo") in [reading for reading, *_ in compared]
    assert np.max([apart for _, *apart in compared]) < EQUAL
    told = "\n".join(found.notes)
    for text in NOTES[name, base]:
        assert text in told
    for mark in CHANGES:
        assert (mark in told) == any(mark in text for text in NOTES[name, base])


@pytest.mark.parametrize(("name", "base"), REFUSED, ids=lambda word: str(word).partition("_")[0])
def test_what_cannot_be_read_is_one_line(name, base):
    with pytest.raises(DataError) as refused:
        found_of(name, base)
    (line,) = str(refused.value).splitlines()
    assert line.startswith(f"{CASES / name}: ")
    assert REFUSED[name, base] in line


def test_a_robot_of_one_joint_has_a_momentum():
    _, robot = found_of("r08_one_joint.urdf")
    nominal, q, v = NominalModel(robot), np.array([[0.4]]), np.array([[1.5]])
    p, beta = momentum_and_beta(nominal, q, v)
    assert p[0] == pytest.approx(mass_matrix(nominal, q[0])[0] * v[0])
    assert beta[0] == pytest.approx(-gravity(nominal, q[0]))  # its inertia is constant


def test_limits_follow_from_motors_by_the_smaller_of_their_ranges():
    _, robot = found_of("m18_motor_with_force_and_control_range.xml")
    assert robot.torque_limits.tolist() == [150.0, 40.0]  # gear x the smaller of force and control
    _, robot = found_of("m17_position_actuator_on_gear.xml")
    assert robot.torque_limits.tolist() == [60.0, 80.0]


def test_hinges_of_one_body_are_joints_in_their_order():
    _, robot = found_of("m07_two_hinges_on_one_body.xml")
    assert robot.layout.actuated == ("shoulder_x", "shoulder_y", "elbow")
    assert robot.layout.groups == {"limb": ("shoulder_x", "shoulder_y", "elbow")}


def test_names_are_words_each_once_and_logs_find_their_own():
    _, robot = found_of("r18_names_equal_after_cleaning.urdf")
    assert [body.name for body in robot.bodies] == ["base", "a_b", "a_b_2"]
    assert [(joint.id, joint.name) for joint in robot.joints] == [("j_1", "j-1"), ("j_1_2", "j.1")]
    _, robot = found_of("r19_names_of_joints_in_chinese.urdf")
    assert [(joint.id, joint.name) for joint in robot.joints] == [("joint_0", "肩"), ("joint_1", "肘")]
    _, robot = found_of("m12_unnamed_joints.xml")
    assert [(joint.id, joint.name) for joint in robot.joints] == [("joint_0", None), ("joint_1", None)]


def test_a_locked_joint_and_what_follows_it_are_welded_at_its_angle():
    found, robot = found_of("r14_gripper_mimic.urdf", locked=["finger_joint=0.3"])
    assert robot.layout.actuated == ("shoulder", "elbow")
    assert "finger_joint: welded at 0.3 rad, as --lock asks for" in found.notes
    assert any(note.startswith("finger_mimic: follows finger_joint; it is welded at -0.3 rad") for note in found.notes)
    assert np.max([apart for _, *apart in differences(robot, found)]) < EQUAL
    other, _ = found_of("r14_gripper_mimic.urdf", locked=["finger_joint"])
    assert other.robot.held != found.robot.held  # at zero
    assert other.bodies[-1]["com"] != found.bodies[-1]["com"]


def test_a_slide_may_be_locked_away_from_zero():
    name = "m03b_slide_with_motor.xml"
    found, robot = found_of(name, locked=["lift=0.5", "elbow=-1"])
    assert robot.layout.actuated == ("shoulder",)
    assert robot.bodies[1].pos == pytest.approx((0.0, 0.0, 0.8))
    assert np.max([apart for _, *apart in differences(robot, found)]) < EQUAL


@pytest.mark.parametrize("word", ["finger=1", "finger_joint=wide", "finger_joint=inf", "=1", "shoulder=0.1=0.2"])
def test_a_word_that_locks_nothing_is_one_line(word):
    with pytest.raises(DataError, match=r"--lock: .* is not accepted; accepted: "):
        import_robot(CASES / "r14_gripper_mimic.urdf", None, 100.0, 10.0, locked=[word])
