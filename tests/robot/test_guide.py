"""The Python of docs/robots.md runs, in its order, and does what the page says."""

import re
from pathlib import Path

from mobnet.settings.robot import RobotTable

ROOT = Path(__file__).parents[2]


def test_the_steps_for_a_new_robot_run(tmp_path, monkeypatch, capsys):
    page = (ROOT / "docs" / "robots.md").read_text()
    (tmp_path / "tests").symlink_to(ROOT / "tests")
    monkeypatch.chdir(tmp_path)
    names = {}
    for block in re.findall(r"^```python\n(.*?)^```$", page, re.DOTALL | re.MULTILINE):
        exec(block, names)
    assert names["residual"].shape == (500, 2)
    assert "robot two-link arm cannot walk; its table lacks: a floating base" in capsys.readouterr().out


def test_the_page_names_every_key_of_a_table():
    page = (ROOT / "docs" / "robots.md").read_text()
    keys = set(
        re.findall(r"`(\w+)`", "".join(line.split("|")[1] for line in page.splitlines() if line.startswith("| `")))
    )
    assert keys == set(RobotTable.model_fields)
