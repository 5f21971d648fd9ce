"""The runner of the benchmarks: every one is run, a missed bar is marked."""

import importlib
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
OTHERS = {"__main__", "long_walk"}


@pytest.fixture
def runner(monkeypatch):
    monkeypatch.syspath_prepend(str(ROOT))
    return importlib.import_module("benchmarks.__main__")


def test_every_benchmark_is_run(runner):
    assert set(runner.NAMES) == {path.stem for path in (ROOT / "benchmarks").glob("*.py")} - OTHERS


def test_the_table_marks_a_missed_bar(runner):
    row = {"name": "walk", "ours": 2.0, "reference": 1.0, "unit": "us", "ratio": 0.5}
    assert "missed" in runner.table([{**row, "bar": 0.65}])
    assert "missed" not in runner.table([{**row, "bar": 0.5}, row])


def test_an_unknown_benchmark_is_named_with_those_accepted(runner, monkeypatch, capsys):
    monkeypatch.setattr(sys, "argv", ["bench", "collet_speed"])
    with pytest.raises(SystemExit, match="2"):
        runner.main()
    message = capsys.readouterr().err
    assert "'collet_speed'" in message
    assert "collect_speed, observer_speed" in message
