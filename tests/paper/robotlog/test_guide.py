"""The maps of docs/logs.md and docs/log_formats.md, and the Python of the former, are right."""

import re
from pathlib import Path

import numpy as np
import yaml

from experiments.check import main as check
from mobnet.formats.loading import load_section
from mobnet.formats.log_map import LogMap, Signal, Tool
from mobnet.formats.plain import as_plain
from mobnet.robotlog.clocks import ClockBounds
from mobnet.robotlog.convert import convert
from mobnet.robotlog.formats import FORMATS, read_log

PAGE, FORMATS_PAGE = Path("docs/logs.md"), Path("docs/log_formats.md")


def test_the_map_of_the_page_reads_the_log_that_it_describes(clean, arm, settings, tmp_path):
    (text,) = re.findall(r"^```yaml\n(clock: {column.*?)^```$", PAGE.read_text(), re.DOTALL | re.MULTILINE)
    (tmp_path / "map.yaml").write_text(text)
    table, sign, constant = clean[:200].copy(), {1: 1, 2: -1}, {1: 9.1, 2: 4.2}
    foreign = {"t": 1e3 * table["time"]}
    for k in (1, 2):
        foreign[f"angle_{k}"] = sign[k] * np.degrees(table[f"q.J{k}"])
        foreign[f"speed_{k}"] = sign[k] * np.degrees(table[f"v.J{k}"])
        foreign[f"current_{k}"] = table[f"tau_motor.J{k}"] / constant[k]
    type(table)(foreign).to_csv(tmp_path / "log.csv", index=False)
    path, meaning = tmp_path / "log.csv", load_section(tmp_path / "map.yaml", LogMap)
    found = convert(path, read_log(path), meaning, arm.layout, as_plain(settings.robotlog, ClockBounds)).recording
    assert found.rate_hz == 1000.0
    assert len(found.sensed) == len(table) - 2  # the torque is brought forward by two samples
    np.testing.assert_allclose(found.sensed.q[:, 1], table["q.J2"][:-2], atol=1e-9)
    np.testing.assert_allclose(found.sensed.tau_motor[:, 0], table["tau_motor.J1"][2:], atol=1e-6)


def test_the_page_names_every_format():
    page = FORMATS_PAGE.read_text()
    assert all(f"`{ending}`" in page for ending in FORMATS if ending.startswith("."))


def test_the_page_names_every_key_of_a_map_and_of_a_signal():
    part = FORMATS_PAGE.read_text().partition("## Keys of a map")[2].partition("\n## ")[0]
    rows = [line.split("|")[1] for line in part.splitlines() if line.startswith("| `")]
    assert set(re.findall(r"`(\w+)`", "".join(rows))) == set(LogMap.model_fields)
    assert set(Signal.model_fields) - set(re.findall(r"`(\w+)`", part)) == set()
    (tool,) = re.findall(r"^ {4}tool: (\{.*\})$", part, re.MULTILINE)
    assert Tool.model_validate(yaml.safe_load(tool)).body == "hand"


def test_the_python_of_the_page_runs_and_its_command_checks_what_it_wrote(tmp_path, monkeypatch):
    page = PAGE.read_text()
    (code,) = re.findall(r"^```python\n(.*?)^```$", page, re.DOTALL | re.MULTILINE)
    (words,) = re.findall(r"^ {4}\./reproduce check (.*)$", page, re.MULTILINE)
    (tmp_path / "tests").symlink_to(Path("tests").resolve())
    monkeypatch.chdir(tmp_path)
    names = {}
    exec(code, names)
    assert names["residual"].shape == (500, 2)
    assert check(words.split()) == 0
    assert check([*words.split()[:-1], "500"]) == 1
