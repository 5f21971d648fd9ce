"""The runner of the benchmarks: every one is run, a missed bar is marked."""

import importlib
import os
import subprocess
import sys
from pathlib import Path

import pytest
import torch

ROOT = Path(__file__).parents[3]
OTHERS = {"__main__", "jobs"}


@pytest.fixture
def runner(monkeypatch):
    monkeypatch.syspath_prepend(str(ROOT))
    return importlib.import_module("benchmarks.__main__")


def test_every_benchmark_has_a_name(runner):
    assert {*runner.NAMES, *runner.LONG} == {path.stem for path in (ROOT / "benchmarks").glob("*.py")} - OTHERS


@pytest.mark.parametrize("name", sorted({path.stem for path in (ROOT / "benchmarks").glob("*.py")} - OTHERS))
def test_a_benchmark_finds_what_it_imports(runner, name):
    assert callable(importlib.import_module(f"benchmarks.{name}").main)


def test_the_table_marks_a_missed_bar(runner):
    row = {"name": "walk", "ours": 2.0, "reference": 1.0, "unit": "us", "ratio": 0.5}
    assert "missed" in runner.table([{**row, "bar": 0.65}])
    assert "missed" not in runner.table([{**row, "bar": 0.5}, row])


@pytest.mark.parametrize(("ours", "missed"), [
    (2.0, False), (2.1, True), (0.9, True), (1.0, False), (float("nan"), True),
])  # fmt: skip
def test_a_quantity_outside_its_bounds_or_not_measured_misses(runner, ours, missed):
    row = {"name": "falls", "ours": ours, "unit": "", "at_least": 1.0, "at_most": 2.0}
    assert runner.misses(row) == missed
    assert ("missed" in runner.table([row])) == missed
    assert not runner.misses({"name": "falls", "ours": ours, "unit": ""})


def test_an_unknown_benchmark_is_named_with_those_accepted(runner, monkeypatch, capsys):
    monkeypatch.setattr(sys, "argv", ["bench", "collet_speed"])
    with pytest.raises(SystemExit, match="2"):
        runner.main()
    message = capsys.readouterr().err
    assert "'collet_speed'" in message
    assert "loop_speed, observer_speed" in message


def test_the_benchmark_of_a_gpu_runs_on_a_cpu_where_it_is_asked_to(runner):
    """Small: two networks of eight units."""
    bench = importlib.import_module("benchmarks.gpu_speed")
    rows = bench.rows(torch.device("cpu"), bench.Sizes(updates=2, rounds=1, sets=1, hidden=8), {2: 0.001})
    assert [row["name"].split(",")[0] for row in rows] == [
        "leg networks side by side", "of 2", "gates in one kernel", "states", "gradients",
    ]  # fmt: skip
    speed, again, kernels, states, gradients = rows
    assert speed["ratio"] == pytest.approx(speed["ours"] / speed["reference"])
    assert again["ours"] == kernels["ours"] == 0.0
    assert states["ours"] < 1e-5
    assert gradients["ours"] < 1e-5
    assert [runner.misses(row) for row in rows] == [False, False, True, False, False]


def test_without_a_gpu_each_row_says_so(runner, monkeypatch, capsys):
    monkeypatch.setattr(torch.cuda, "is_available", lambda: False)
    assert importlib.import_module("benchmarks.gpu_speed").main() == []
    assert capsys.readouterr().err.count("no GPU here: ") == 3


WITHOUT = """
import sys
for name in ("numba", "llvmlite", "scipy", "pandas", "mujoco", "pinocchio", "matplotlib", "onnx", "snakemake"):
    sys.modules[name] = None  # as if it were not installed
import torch
from benchmarks.gpu_speed import Sizes, leg, load_lab, made_up, side_by_side_speed
sizes = Sizes(updates=2, rounds=1, sets=1, hidden=8)
lab = load_lab()
training = leg(lab, sizes)
print(len(side_by_side_speed(training, [made_up(lab, training, sizes, 0)], 2, torch.device("cpu"))))
"""


def test_the_benchmark_of_a_gpu_needs_few_packages():
    """A machine with a GPU may have no environment of the project's."""
    environment = {**os.environ, "PYTHONPATH": str(ROOT / "src")}
    done = subprocess.run([sys.executable, "-c", WITHOUT], cwd=ROOT, env=environment, capture_output=True, text=True)
    assert done.stdout == "1\n", done.stderr
