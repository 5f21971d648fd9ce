"""The four commands of the README lead from a URDF to flags, and print what it says."""

import logging
import re
from pathlib import Path

import pytest

from experiments.commands.words import parse
from mobnet.detection.calibrate import main as calibrate
from mobnet.robot.import_table import main as robot
from mobnet.robotlog.detect import main as detect
from mobnet.robotlog.motion import main as motion
from mobnet.robotlog.observe import main as observe

pytestmark = pytest.mark.slow
ROOT = Path(__file__).parents[3]
README = (ROOT / "README.md").read_text().split("\n## Your own robot")[1].split("\n## ")[0]
COMMANDS = {"robot": robot, "observe": observe, "calibrate": calibrate, "detect": detect, "motion": motion}
# The logs of which the README tells: minutes and seed of free motion, and of a minute with pushes.
LOGS = (
    "motion --robot arm.yaml --minutes 5 --seed 1 --out free.csv",
    "motion --robot arm.yaml --minutes 1 --seed 2 --pushes --out new.csv",
)


def run(line: str) -> None:
    """Run a line as `./reproduce` does."""
    taken = parse(line.split())
    assert COMMANDS[taken.command](taken.extra) == 0, line


def test_the_arm_of_the_readme_gets_its_flags(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    first, *others = re.findall(r"^ {4}\./reproduce (.*)$", README, re.MULTILINE)
    assert [line.split()[0] for line in (first, *others)] == ["robot", "observe", "calibrate", "detect"]
    said = re.findall(r"^ {4}(?!\./)(.*)$", README, re.MULTILINE)
    assert len(said) == 1
    (urdf,) = re.findall(r"\((tests/data/\S+\.urdf)\)", README)
    monkeypatch.chdir(tmp_path)
    caplog.set_level(logging.INFO)
    Path("my_arm.urdf").write_text((ROOT / urdf).read_text())
    for line in (first, *LOGS, *others):
        run(line)
    printed = [message.strip() for message in "\n".join(caplog.messages).splitlines()]
    for line in said:
        assert line in printed
