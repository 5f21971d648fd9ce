"""Python and commands of docs/robots.md run, in their order, and do what the page says."""

import re
from pathlib import Path

from mobnet.formats.loading import load_section
from mobnet.formats.robot import RobotTable
from mobnet.robot.import_table import main as import_table

ROOT = Path(__file__).parents[3]


def test_the_steps_for_a_new_robot_run(tmp_path, monkeypatch, capsys):
    page = (ROOT / "docs" / "robots.md").read_text()
    (tmp_path / "tests").symlink_to(ROOT / "tests")
    monkeypatch.chdir(tmp_path)
    names = {}
    for block in re.findall(r"^```python\n(.*?)^```$", page, re.DOTALL | re.MULTILINE):
        exec(block, names)
    assert names["robot"].layout.nu == 2
    assert "robot two-link arm cannot walk; its table lacks: a floating base" in capsys.readouterr().out


def test_the_commands_of_the_page_make_a_table(tmp_path, monkeypatch):
    page = (ROOT / "docs" / "robots.md").read_text()
    (tmp_path / "tests").symlink_to(ROOT / "tests")
    monkeypatch.chdir(tmp_path)
    (words,) = re.findall(r"^ {4}\./reproduce robot (tests/.*)$", page, re.MULTILINE)
    assert import_table(words.split()) == 0
    assert load_section(tmp_path / "two_links.yaml", RobotTable).layout.nu == 2


def test_the_page_names_every_key_of_a_table():
    part = (ROOT / "docs" / "robots.md").read_text().partition("### From a URDF")[0]
    rows = [line.split("|")[1] for line in part.splitlines() if line.startswith("| `")]
    assert set(re.findall(r"`(\w+)`", "".join(rows))) == set(RobotTable.model_fields)
