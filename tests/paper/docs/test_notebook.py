"""docs/examples/push.ipynb runs from its first cell to its last, and its errors are those of the demo."""

import ast
import json
import os
import re
import subprocess
import sys
from pathlib import Path

import nbformat
import pytest
from push_notebook import FOLDER, NOTEBOOK, cells, program

import mobnet
from experiments.settings.load import load_settings

DEMO = Path(__file__).parents[3] / "docs" / "demo.md"
PACKAGES = {"pathlib", "matplotlib.pyplot", "numpy", "pyarrow.parquet", "mobnet"}
TOLD = """
import json
drawn = [len(axis.lines) for number in plt.get_fignums() for axis in plt.figure(number).axes]
late = [int(np.argmax(residual_of(gain_hz)[close])) for gain_hz in (20.0, 200.0)]
told = {
    "errors": errors, "gain": GAIN_HZ, "settled_s": SETTLED / rate_hz, "drawn": drawn, "late": late,
    "joint": JOINT, "shares": {name: float(share) for name, share in shares.items()},
}
print(json.dumps(told))
"""


@pytest.fixture(scope="module")
def told(tmp_path_factory):
    """What the cells have computed, in a process that begins in the folder of the notebook, as Jupyter does."""
    variables = {**os.environ, "MPLBACKEND": "agg", "MPLCONFIGDIR": str(tmp_path_factory.mktemp("matplotlib"))}
    command = [sys.executable, "-c", program() + TOLD]
    done = subprocess.run(command, cwd=FOLDER, env=variables, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr
    return json.loads(done.stdout.splitlines()[-1])


def test_it_is_a_notebook_without_outputs():
    nbformat.validate(nbformat.read(NOTEBOOK, as_version=4))
    code = [cell for cell in cells() if cell.cell_type == "code"]
    assert len(code) >= 6
    assert [cell for cell in code if cell.outputs or cell.execution_count is not None] == []


def test_it_needs_public_names_and_packages_that_come_with_them_alone():
    tree = ast.parse(program())
    imported = {name.name for node in ast.walk(tree) if isinstance(node, ast.Import) for name in node.names}
    imported |= {str(node.module) for node in ast.walk(tree) if isinstance(node, ast.ImportFrom)}
    assert imported == PACKAGES
    assert set(re.findall(r"\bmobnet\.(\w+)", program())) <= set(mobnet.__all__)


def test_its_errors_are_those_that_the_demo_prints(told):
    errors = dict(re.findall(r"^(MOB|MOB-Net-pushed) .*RMSE ([\d.]+) N m", DEMO.read_text(), re.MULTILINE))
    found = {"MOB": told["errors"]["observer"], "MOB-Net-pushed": told["errors"]["MOB-Net-pushed"]}
    assert {name: f"{error:.1f}" for name, error in found.items()} == errors


def test_its_numbers_are_those_of_the_configuration(told):
    settings = load_settings()
    story = settings.evaluation.story
    assert told["gain"] == settings.observer.gain_hz
    assert (told["settled_s"], told["joint"]) == (story.settle_s, story.joint)


def test_it_draws_residuals_of_each_gain_estimates_and_their_error(told):
    curves, estimates, error = told["drawn"]
    assert (curves, estimates, error) == (4, 3, 1)
    slow, fast = told["late"]
    assert slow > fast


def test_the_exercise_finds_that_sigma_is_too_small_during_the_push(told):
    assert told["shares"]["push"] < 0.5 < told["shares"]["rest"]
