"""`./reproduce motion`: a simulated log of a robot of one's own, which `./reproduce observe` takes without a map."""

import logging
import re
from pathlib import Path

import pandas as pd
import pytest

from mobnet.robotlog.motion import main
from mobnet.robotlog.observe import main as observe

ARM = Path("tests/data/arm.yaml")
PAGE = Path("docs/robots.md").read_text()
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


def test_the_commands_of_the_page_make_its_logs(say, tmp_path, monkeypatch):
    (table,) = re.findall(r"^ {4}cp (\S+) arm\.yaml$", PAGE, re.MULTILINE)
    (tmp_path / "arm.yaml").symlink_to(Path(table).resolve())
    monkeypatch.chdir(tmp_path)
    for line in re.findall(r"^ {4}\./reproduce motion (.*)$", PAGE, re.MULTILINE):
        status, lines = say(main, *re.sub(r"--minutes \d+", "--minutes 0.02", line).split())
        assert (status, lines[0]) == (0, "Panda: 1200 samples at 1000 Hz, 1.2 s; shapes keep apart")
    assert {"train.csv", "free.csv", "new.csv"} == {path.name for path in tmp_path.glob("*.csv")}
    assert "pushed" in pd.read_csv("new.csv")


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
        (("--seed", "0"), "--seed: 0 is not accepted; accepted: a whole number from 1 on"),
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
