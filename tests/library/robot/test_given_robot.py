"""A robot that a user names by a file without a table: by its ending, from a pipe, or from standard input."""

import os
import shlex
import subprocess
import sys
from pathlib import Path

import pytest

from mobnet.core.errors import DataError
from mobnet.core.options import export_parser, import_parser, missing_input, observe_parser
from mobnet.core.word_checks import imported_table
from mobnet.formats.loading import load_section
from mobnet.formats.robot import RobotTable
from mobnet.interface import Robot
from mobnet.robot.given import given_robot, given_table, is_robot_file
from mobnet.robot.import_file import read_file
from mobnet.settings.lab import load_lab

URDF = Path("tests/data/arm.urdf").resolve()
MJCF = Path(__file__).parent / "cases" / "m00_plain.xml"


@pytest.fixture
def piped():
    """A function bytes -> the path of an open pipe that holds them, as a shell's <(...) names it."""
    readers = []

    def pipe(content):
        reader, writer = os.pipe()
        readers.append(reader)
        os.write(writer, content)
        os.close(writer)
        return Path(f"/dev/fd/{reader}")

    yield pipe
    for reader in readers:
        os.close(reader)


@pytest.mark.parametrize("path", [URDF, MJCF], ids=["URDF", "MJCF"])
def test_a_pipe_may_be_looked_at_twice(path, piped):
    lab = load_lab()
    pipe = piped(path.read_bytes())
    robot = given_robot(pipe, lab.robot)
    table = given_table(pipe, lab.robot)
    assert robot.bodies == table.bodies == given_robot(path, lab.robot).bodies
    assert robot.notes
    assert robot.name == given_robot(path, lab.robot).name


def test_each_pipe_holds_its_robot(piped):
    first, second = piped(URDF.read_bytes()), piped(b"<robot name='other'/>")
    assert read_file(first).root.get("name") == "two-link arm"
    assert read_file(second).root.get("name") == "other"
    assert read_file(first).root.get("name") == "two-link arm"


def test_a_program_reads_a_robot_from_a_pipe(piped):
    assert Robot.read(piped(URDF.read_bytes())).description.layout.nu == 2


def test_a_table_from_a_pipe_is_one_line(piped):
    pipe = piped(b"name: arm\nbase: fixed\n")
    with pytest.raises(DataError) as refused:
        given_robot(pipe, load_lab().robot)
    (line,) = str(refused.value).splitlines()
    assert line.startswith(f"{pipe}: text before the first element, 'name: arm', is not accepted; accepted: a URDF")


def test_a_terminal_is_one_line():
    master, terminal = os.openpty()
    with pytest.raises(DataError, match="a terminal is not accepted; accepted: a URDF or MJCF file, or a pipe"):
        read_file(Path(f"/dev/fd/{terminal}"))
    os.close(master)
    os.close(terminal)


def test_a_descriptor_that_is_not_open_is_one_line():
    with pytest.raises(DataError, match="cannot be read: Bad file descriptor"):
        read_file(Path("/dev/fd/9999"))


@pytest.mark.parametrize("name", ["arm.urdf", "ARM.URDF", "arm.urdf.gz", "arm.xml", "arm.mjcf", "-", "/dev/fd/63"])
def test_what_is_no_table_is_seen_by_its_name(name):
    assert is_robot_file(Path(name))
    assert not is_robot_file(Path(f"{name}.yaml"))


@pytest.mark.parametrize(
    ("word", "table"),
    [("a/ur.v2.urdf", "ur.v2.yaml"), ("ur.urdf.gz", "ur.yaml"), ("-", "robot.yaml"), ("/dev/fd/63", "robot.yaml")],
)
def test_a_table_has_the_name_of_its_file(word, table):
    assert imported_table(import_parser().parse_args([word])) == Path(table)


def test_standard_input_is_a_robot_s_and_only_once(tmp_path):
    (tmp_path / "log.csv").touch()
    words = observe_parser().parse_args([str(tmp_path / "log.csv"), "--robot", "-"])
    assert missing_input(words) is None
    assert missing_input(import_parser().parse_args(["-"])) is None
    assert missing_input(export_parser().parse_args(["--robot", "-", "--out", "x"])) is None
    for log in ("-", "/dev/stdin", "/dev/fd/0"):
        line = missing_input(observe_parser().parse_args([log, "--robot", "-"]))
        assert line == "log and robot: standard input for both is not accepted; accepted: a file for one of them"
    assert missing_input(observe_parser().parse_args(["-"])) is None


SHELL = {
    "standard input": "{program} robot - --base fixed --out {out} < {file}",
    "a pipe into it": "cat {file} | {program} robot - --base fixed --out {out}",
    "a shell's pipe": "{program} robot <(cat {file}) --base fixed --out {out}",
}


@pytest.mark.parametrize("line", SHELL.values(), ids=SHELL)
def test_a_shell_hands_a_robot_over(line, tmp_path):
    out = tmp_path / "arm.yaml"
    program = f"{shlex.quote(sys.executable)} -m mobnet"
    script = line.format(program=program, file=shlex.quote(str(URDF)), out=shlex.quote(str(out)))
    done = subprocess.run(["bash", "-c", script], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    assert load_section(out, RobotTable).layout.actuated == ("J1", "J2")
