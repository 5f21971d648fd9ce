"""What public files of robots have beside a plain tree of links: odd XML, limits, masses, forces."""

import gzip
from pathlib import Path

import numpy as np
import pinocchio as pin
import pytest

from mobnet.core.errors import DataError
from mobnet.formats.parts import GYRATION_M, MOST_KG
from mobnet.robot.import_checks import differences
from mobnet.robot.import_file import read_file
from mobnet.robot.import_table import robot_of_text, table_text
from mobnet.robot.importing import import_robot

CASES = Path(__file__).parent / "cases"
PLAIN = (CASES / "r00_plain.urdf").read_text()
ARM = (CASES / "m00_plain.xml").read_text()
EQUAL = 1e-10
LOWER = '<mass value="1.0"/><inertia ixx="0.01" iyy="0.01" izz="0.01"'
ELBOW = '<limit lower="-2" upper="2" effort="50" velocity="5"/></joint>\n</robot>'


def changed(text, *changes):
    """Return a text in which the last place of each old word is replaced."""
    for old, new in changes:
        before, is_there, after = text.rpartition(old)
        assert is_there
        text = f"{before}{new}{after}"
    return text


@pytest.fixture
def read(tmp_path):
    """A function text, base -> what is imported of it and the robot of its table."""

    def import_text(text, name="arm.urdf", floating=None):
        path = tmp_path / name
        path.write_bytes(text if isinstance(text, bytes) else text.encode())
        imported = import_robot(path, floating, 100.0, 10.0)
        return imported, robot_of_text(table_text(imported, name), path, imported)

    return import_text


def rows_of(pair):
    """Return bodies and joints of the robot of a table, beside what was imported."""
    _, robot = pair
    return robot.bodies, robot.joints


XML = {
    "default namespace of ROS": changed(PLAIN, ("<robot ", '<robot xmlns="http://www.ros.org" ')),
    "default namespace of Drake": changed(PLAIN, ("<robot ", '<robot xmlns="http://drake.mit.edu" ')),
    "prefix without namespace": changed(
        PLAIN, ("</robot>", '<gazebo><sensor:camera name="rgb"/><b gz:type="x"/></gazebo></robot>')
    ),
    "prefix inside a link": changed(PLAIN, ("</link>", '<drake:rotor value="1"/></link>')),
    "declaration on line 2": f"\n{PLAIN}",
    "declaration behind a comment": f"  <!-- of the arm -->\n{PLAIN}",
    "no declaration": PLAIN.partition("\n")[2],
    "hyphens in a comment": changed(PLAIN, ("<link", "<!-- a -- b <link> ---><link")),
    "a mark of bytes": f"\ufeff{PLAIN}",
    "UTF-16": PLAIN.encode("utf-16"),
    "Latin-1 that it does not declare": changed(PLAIN, ("<link", "<!-- 90° --><link")).encode("latin-1"),
}


@pytest.mark.parametrize("text", XML.values(), ids=XML)
def test_xml_that_other_readers_take_makes_the_same_table(text, read):
    imported, robot = read(text)
    assert rows_of((imported, robot)) == rows_of(read(PLAIN))
    assert {reading for reading, *_ in differences(robot, imported)} == {"Pinocchio", "MuJoCo"}


def test_a_file_is_read_once(read, tmp_path, monkeypatch):
    imported, robot = read(PLAIN)
    (tmp_path / "arm.urdf").write_text("gone")
    assert np.max([apart for _, *apart in differences(robot, imported)]) < EQUAL


@pytest.mark.parametrize(
    ("text", "message"),
    [
        (f"String value is: {PLAIN}", "text before the first element, 'String value is:', is not accepted"),
        (PLAIN.replace("</robot>", "<!-- no end"), "accepted: a URDF or MJCF file"),
        ('<?xml version="1.0" encoding="klingon"?><robot/>', "unknown encoding: klingon"),
    ],
    ids=["words before", "no end", "encoding"],
)
def test_what_is_no_xml_is_one_line_with_its_reason(text, message, read):
    with pytest.raises(DataError) as refused:
        read(text)
    assert message in str(refused.value)
    assert len(str(refused.value).splitlines()) == 1


def test_an_error_names_its_line_of_the_file(read):
    with pytest.raises(DataError, match="line 5"):
        read('\n<?xml version="1.0"?>\n<!-- two\nlines --><robot>\n</link>')


def test_xacro_under_another_prefix_is_seen(read):
    text = changed(
        PLAIN, ("<robot ", '<robot xmlns:x="http://ros.org/wiki/xacro" '), ("</robot>", "<x:include/></robot>")
    )
    with pytest.raises(DataError, match="xacro:include is not accepted; accepted: a URDF, made of xacro by"):
        read(text)


def test_a_packed_file_is_read(read, tmp_path):
    assert rows_of(read(gzip.compress(PLAIN.encode()), "arm.urdf.gz")) == rows_of(read(PLAIN))
    assert rows_of(read(gzip.compress(ARM.encode()), "arm.xml.gz")) == rows_of(read(ARM, "arm.xml"))
    (tmp_path / "cut.urdf.gz").write_bytes(gzip.compress(PLAIN.encode())[:40])
    with pytest.raises(DataError, match="accepted: a URDF or MJCF file"):
        read_file(tmp_path / "cut.urdf.gz")


def test_a_file_without_masses_is_told_with_its_links(read):
    text = "\n".join(
        line if "<link" not in line else line.partition("<inertial")[0] + "</link>" for line in PLAIN.splitlines()
    )
    with pytest.raises(DataError) as refused:
        read(text)
    (line,) = str(refused.value).splitlines()
    assert "no <inertial> with a mass in any link that a hinge moves (upper, lower); accepted: mass and inertia" in line


def test_a_link_without_mass_above_a_fixed_joint_is_one_body_with_what_it_carries(read):
    text = changed(
        PLAIN,
        ('<link name="lower">', '<link name="lower"/>\n<link name="tool">'),
        ("</robot>", '<joint name="f" type="fixed"><parent link="lower"/><child link="tool"/></joint></robot>'),
    )
    imported, robot = read(text)
    assert robot.bodies == read(PLAIN)[1].bodies
    assert not any("no mass" in note for note in imported.notes)


@pytest.mark.parametrize("number", ["-1", "-1.0", "0", "inf", "nan"])
def test_a_limit_that_means_none_is_the_default_with_a_note(number, read):
    limit = f'<limit lower="-2" upper="2" effort="{number}" velocity="{number}"/></joint>\n</robot>'
    imported, robot = read(changed(PLAIN, (ELBOW, limit)))
    assert [joint.torque_limit for joint in robot.joints] == [50.0, 100.0]
    assert [joint.velocity_limit for joint in robot.joints] == [5.0, 10.0]
    assert any(note.startswith("torque of elbow: not in the file") for note in imported.notes)
    assert any(note.startswith("speed of elbow: not in the file") for note in imported.notes)


def test_a_range_that_is_turned_round_is_turned_with_a_note(read):
    imported, robot = read(changed(PLAIN, ('lower="-2" upper="2"', 'lower="1.5" upper="-2"')))
    assert robot.joints[1].range == (-2.0, 1.5)
    assert "range of elbow: the lower end is above the upper one; they change places" in imported.notes
    assert not any(note.startswith("range of elbow: not") for note in imported.notes)


def test_a_heavy_link_is_read(read):
    imported, robot = read(changed(PLAIN, (LOWER, LOWER.replace("1.0", "1385.5").replace("0.01", "120"))))
    assert robot.bodies[-1].mass == 1385.5
    assert np.max([apart for _, *apart in differences(robot, imported)]) < EQUAL


def test_a_placeholder_for_an_inertia_is_read_and_its_link_noted(read):
    imported, robot = read(changed(PLAIN, (LOWER, LOWER.replace("1.0", "0.05").replace("0.01", "1"))))
    assert robot.bodies[-1].inertia[0] == 1.0
    assert any(note.startswith("lower: 0.05 kg") and "radius of gyration of 4.47 m" in note for note in imported.notes)


TOOL = """<link name="tool"><inertial><mass value="{mass}"/><inertia ixx="{i}" iyy="{i}" izz="{i}"/>
</inertial></link><joint name="flange" type="fixed"><parent link="lower"/><child link="tool"/></joint></robot>"""


@pytest.mark.parametrize(
    ("mass", "inertia", "message"),
    [
        (19342.3, 10.0, f"link tool: mass 19342.3 kg is not accepted; accepted: above 0 to {MOST_KG:g} kg"),
        (1.0, 100.0, "link tool: 1 kg with the principal moments 100, 100, 100 kg m^2, a radius of gyration of 10 m"),
    ],
    ids=["mass", "inertia"],
)  # fmt: skip
def test_a_wrong_mass_is_told_by_the_link_that_has_it(mass, inertia, message, read):
    with pytest.raises(DataError) as refused:
        read(changed(PLAIN, ("</robot>", TOOL.format(mass=mass, i=inertia))))
    (line,) = str(refused.value).splitlines()
    assert message in line


def test_each_link_with_a_wrong_mass_has_its_line(read, tmp_path):
    with pytest.raises(DataError) as refused:
        read(PLAIN.replace(LOWER, LOWER.replace("1.0", "56143")))
    lines = str(refused.value).splitlines()
    assert [line.partition(": mass")[0] for line in lines] == [
        f"{tmp_path / 'arm.urdf'}: link upper", f"{tmp_path / 'arm.urdf'}: link lower"
    ]  # fmt: skip


def test_links_that_are_too_wide_only_together_are_named_together(read):
    text = changed(PLAIN, (LOWER, LOWER.replace("0.01", "24.0")), ("</robot>", TOOL.format(mass=0.01, i=4.0)))
    low, high = GYRATION_M
    with pytest.raises(DataError, match=rf"link.* tool.*radius of gyration.*accepted: {low} to {high} m"):
        read(text)


def test_another_number_that_a_table_does_not_take_is_told_by_the_name_of_its_link(read):
    with pytest.raises(DataError, match=r"arm\.urdf: link lower: pos\.2: 7\.0 is not accepted"):
        read(changed(PLAIN, ('<origin xyz="0 0 0.3"/>', '<origin xyz="0 0 7"/>')))


@pytest.mark.parametrize("leader", ["left_elbow", "elbow"])
def test_a_joint_whose_leader_is_not_there_or_itself_is_welded_and_says_so(leader, read):
    imported, robot = read(changed(PLAIN, ("</joint>", f'<mimic joint="{leader}"/></joint>')))
    what = "follows itself" if leader == "elbow" else "follows left_elbow, which is not in the file"
    assert any(note.startswith(f"elbow: {what}; it is welded at 0 rad") for note in imported.notes)
    assert robot.layout.actuated == ("shoulder",)


QUATERNION = '<origin xyz="0 0 0.3" quat_xyzw="{}"{}/>'


@pytest.mark.parametrize("version", ["1.1", "1.2"])
def test_a_quaternion_of_a_place_is_read_as_pinocchio_reads_it(version, read):
    place = ('<origin xyz="0 0 0.3"/>', QUATERNION.format("0.6 0 0 0.8", ""))
    of_mass = ('<origin xyz="0 0 0.1"/>', '<origin xyz="0 0 0.1" quat_xyzw="0 2 0 1"/>')
    tensor = ('ixx="0.01" iyy="0.01"', 'ixx="0.02" iyy="0.015"')
    text = changed(PLAIN, place, of_mass, tensor).replace("<robot ", f'<robot version="{version}" ')
    imported, robot = read(text)
    model = pin.buildModelFromXML(text)
    x, y, z, w = pin.Quaternion(model.jointPlacements[2].rotation).coeffs()
    assert robot.bodies[2].quat == pytest.approx((w, x, y, z))
    xx, yy, zz, xy, xz, yz = robot.bodies[2].inertia
    np.testing.assert_allclose(model.inertias[2].inertia, [[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]], atol=1e-15)
    notes = []
    ((reading, *apart),) = differences(robot, imported, notes)
    assert reading == "Pinocchio"
    assert max(apart) < EQUAL
    assert notes == ["not compared with MuJoCo's own reading: it takes no notice of quat_xyzw"]


@pytest.mark.parametrize(
    ("version", "quaternion", "angles", "message"),
    [
        ("", "1 0 0 1", "", 'version 1.0 is not accepted; accepted: rpy, or version="1.1"'),
        ("1.0", "1 0 0 1", "", 'version 1.0 is not accepted; accepted: rpy, or version="1.1"'),
        ("1.1", "1 0 0 1", ' rpy="0 0 0"', "joint elbow: an origin with rpy and quat_xyzw is not accepted"),
        ("1.1", "1 0 0", "", "joint elbow: quat_xyzw '1 0 0' is not accepted; accepted: 4 numbers"),
        ("1.1", "0 0 0 0", "", "joint elbow: quat_xyzw '0 0 0 0' is not accepted; accepted: a direction"),
    ],
)
def test_a_quaternion_that_readers_take_otherwise_is_refused(version, quaternion, angles, message, read):
    text = changed(PLAIN, ('<origin xyz="0 0 0.3"/>', QUATERNION.format(quaternion, angles)))
    with pytest.raises(DataError) as refused:
        read(text.replace("<robot ", f'<robot version="{version}" '))
    assert message in str(refused.value)


def test_a_free_joint_with_a_rotor_by_a_default_is_read_without_it(read):
    text = changed(
        ARM,
        ("<worldbody>", '<default><joint armature="0.1"/></default><worldbody>'),
        ('<body name="base">', '<body name="base"><joint name="root" type="free"/>'),
    )
    imported, robot = read(text, "arm.xml")
    ((_, *apart),) = differences(robot, imported)
    assert max(apart) < EQUAL
    assert robot.floating
    assert robot.armature.tolist() == [0.1, 0.1]
    assert "armature of the free joint of base: not taken over; a base has no rotor" in imported.notes


FORCES = {
    "springs": ('<joint name="elbow"', '<joint stiffness="3" springref="0.4" name="elbow"', "springs (stiffness) of"),
    "gravcomp": ('<body name="lower"', '<body gravcomp="1" name="lower"', "gravcomp of lower: not taken over"),
    "fluid": ("<worldbody>", '<option density="1.2"/><worldbody>', "fluid, density 1.2 kg/m^3, viscosity 0 Pa s: not"),
    "springs of tendons": (
        "</mujoco>",
        '<tendon><fixed stiffness="4"><joint joint="elbow" coef="1"/></fixed></tendon></mujoco>',
        "springs of tendons: not taken over",
    ),
}  # fmt: skip


@pytest.mark.parametrize(("old", "new", "note"), FORCES.values(), ids=FORCES)
def test_a_force_that_a_table_does_not_hold_has_one_note(old, new, note, read):
    plain = read(ARM, "arm.xml")
    forced = read(changed(ARM, (old, new)), "arm.xml")
    (added,) = [line for line in forced[0].notes if line not in plain[0].notes]
    assert added.startswith(note)
    assert rows_of(forced) == rows_of(plain)
