"""Every script of examples/ is short, runs, prints what it found and draws one picture."""

import re
import runpy
from pathlib import Path

import matplotlib
import matplotlib.pyplot as plt
import pytest
from c_library import HAS_COMPILER, REASON

ROOT = Path(__file__).parents[3]
EXAMPLES = ROOT / "examples"
SCRIPTS = sorted(path.stem for path in EXAMPLES.glob("*.py") if path.stem != "simulated")
LONGEST = 40  # lines
SAID = {
    "two_link_urdf": r"^shoulder: not pushed\nelbow: pushed from 1\.0\d\d s on$",
    "six_joint_arm": r"^elbow_joint: flag at 1\.0\d\d s$",
    "control_loop": r"^stop at 1\.00\d s: shoulder3_joint is pushed",
    "friction": r"^friction known: 0\.0\d N m",
    "wrench_at_the_tool": r"^force at the tool: \[\S+e-\d+ +1\.2e\+01 +-2\.0e\+01\]",
    "floating_humanoid": r"^force on the base \[ ?[78]\.\d* ",
    "model_in_code": r"^while it is pushed: \[ ?(?:3\.99|4\.0?)",
    "sliding_axes": r"^force at the tool: \[14\.9\d ",
    "mimic_gripper": r"^after half a second: \[ ?-?0\. +5\. ?\]",
    "ball_and_screw": r"^while it is pushed: \[ ?2\. ",
    "g1_table": r"^largest difference of the two residuals: \d\.\de-1\d N m$",
    "to_c": r"^samples with an alarm in C: (\d{3}), in Python: \1$",
    "with_a_network": r"^observer and network: error in the air 2\.\d N m$",
}


def test_there_are_twelve_or_more_and_the_page_lists_them():
    assert len(SCRIPTS) >= 12
    assert (
        sorted(re.findall(r"^\| \[(\w+)\.py\]\(\1\.py\)", (EXAMPLES / "README.md").read_text(), re.MULTILINE))
        == SCRIPTS
    )


@pytest.mark.parametrize("name", SCRIPTS)
def test_an_example_finds_what_it_should(name, tmp_path, monkeypatch, capsys):
    if name == "to_c" and not HAS_COMPILER:
        pytest.skip(REASON)
    matplotlib.use("Agg")
    monkeypatch.chdir(tmp_path)
    monkeypatch.syspath_prepend(EXAMPLES)
    script = EXAMPLES / f"{name}.py"
    assert len(script.read_text().splitlines()) <= LONGEST
    runpy.run_path(str(script), run_name="__main__")
    plt.close("all")
    said = capsys.readouterr().out
    assert re.search(SAID[name], said, re.MULTILINE), said
    assert [path.name for path in tmp_path.iterdir()] == [f"{name}.png"]
