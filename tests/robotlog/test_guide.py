"""The map of docs/robots.md is one, and a log that it describes is read as it says."""

import re
from pathlib import Path

import numpy as np

from mobnet.robotlog.convert import convert
from mobnet.robotlog.formats import FORMATS, read_log
from mobnet.settings.lab import load_section
from mobnet.settings.robotlog import LogMap

PAGE = Path("docs/robots.md")


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
    found = convert(path, read_log(path), meaning, arm.layout, settings.robotlog).recording
    assert found.rate_hz == 1000.0
    assert len(found.sensed) == len(table) - 2  # the torque is brought forward by two samples
    np.testing.assert_allclose(found.sensed.q[:, 1], table["q.J2"][:-2], atol=1e-9)
    np.testing.assert_allclose(found.sensed.tau_motor[:, 0], table["tau_motor.J1"][2:], atol=1e-6)


def test_the_page_names_every_format():
    page = PAGE.read_text()
    assert all(f"`{ending}`" in page for ending in FORMATS if ending.startswith("."))
