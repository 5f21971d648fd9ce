"""`./reproduce motion`: a simulated log of a robot of one's own, which `./reproduce observe` takes without a map."""

import logging
from pathlib import Path

import pandas as pd
import pytest

from mobnet.robotlog.motion import main
from mobnet.robotlog.observe import main as observe

ARM = Path("tests/data/arm.yaml")
PANDA = Path("configs/robots/panda.yaml")


@pytest.fixture
def say(caplog):
    def run(command, *words):
        caplog.clear()
        with caplog.at_level(logging.INFO):
            status = command([str(word) for word in words])
        return status, caplog.messages

    return run


def test_a_log_is_observed_without_a_map_and_without_a_hint(say, tmp_path):
    out = tmp_path / "panda.csv"
    status, lines = say(main, "--robot", PANDA, "--minutes", 0.2, "--out", out)
    assert status == 0
    assert lines[0] == "Panda: 12000 samples at 1000 Hz, 12 s; shapes keep apart"
    status, lines = say(observe, out, "--robot", PANDA, "--out", tmp_path / "seen")
    assert status == 0
    assert "hints: none" in lines
    assert {"recording.parquet", "estimate.parquet", "residual.png"} <= {p.name for p in (tmp_path / "seen").iterdir()}


def test_the_truth_stands_in_a_log_with_pushes_alone(say, tmp_path):
    for words, has in (((), False), (("--pushes",), True)):
        say(main, "--robot", ARM, "--minutes", 0.1, "--out", tmp_path / "arm.csv", *words)
        table = pd.read_csv(tmp_path / "arm.csv")
        assert list(table.columns)[:7] == ["time", "q.J1", "q.J2", "v.J1", "v.J2", "tau_motor.J1", "tau_motor.J2"]
        assert {"tau_ext.J1", "tau_ext.J2", "pushed"}.issubset(table.columns) == has


def test_equal_words_make_equal_files_in_both_formats(say, tmp_path):
    for ending in ("csv", "parquet"):
        for name in ("one", "two"):
            say(main, "--robot", ARM, "--minutes", 0.05, "--seed", 7, "--out", tmp_path / f"{name}.{ending}")
        assert (tmp_path / f"one.{ending}").read_bytes() == (tmp_path / f"two.{ending}").read_bytes()
    pd.testing.assert_frame_equal(pd.read_csv(tmp_path / "one.csv"), pd.read_parquet(tmp_path / "one.parquet"))


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (("--minutes", "0"), "--minutes: 0.0 is not accepted; accepted: above 0 and up to 60"),
        (("--seed", "-1"), "--seed: -1 is not accepted; accepted: a whole number from 0 on"),
        (("--out", "log.bag"), "--out: ending: '.bag' is not accepted; accepted: .csv, .parquet"),
        (("--robot", "none.yaml"), "none.yaml"),
    ],
    ids=["minutes", "seed", "ending", "robot"],
)
def test_what_is_not_accepted_is_one_line(words, message, say, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    status, lines = say(main, *words)
    assert (status, len(lines)) == (1, 1)
    assert message in lines[0]
    assert not list(tmp_path.iterdir())
