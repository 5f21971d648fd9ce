"""`./reproduce motion`: a simulated log of a robot of one's own, which `./reproduce observe` takes without a map."""

import logging
import re
import weakref
from dataclasses import replace
from pathlib import Path

import pandas as pd
import pytest

from mobnet.core.recording import Recording
from mobnet.formats.loading import load_section
from mobnet.formats.robot import RobotTable
from mobnet.robot.description import describe
from mobnet.robotlog.motion import main, report_lines, write_log
from mobnet.robotlog.observe import main as observe
from mobnet.simulation.free_run import Numbers, record_motion

ARM = Path("tests/data/arm.yaml")
PAGE = Path("docs/logs.md").read_text()
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


@pytest.mark.parametrize("ending", ["csv", "parquet"])
def test_the_pieces_in_which_a_log_is_made_change_no_number(ending, say, tmp_path, monkeypatch):
    """Noise, motion and pushes go on from one piece to the next."""
    told = []
    for name, rows in (("whole", 60_000), ("pieces", 500)):
        monkeypatch.setattr("mobnet.simulation.free_run.PIECE", rows)
        words = ("--robot", ARM, "--minutes", 0.05, "--pushes", "--out", tmp_path / f"{name}.{ending}")
        told.append(say(main, *words)[1][:-1])
    read = {"csv": pd.read_csv, "parquet": pd.read_parquet}[ending]
    pd.testing.assert_frame_equal(read(tmp_path / f"pieces.{ending}"), read(tmp_path / f"whole.{ending}"))
    assert told[0] == told[1]


def test_of_a_log_no_more_than_two_pieces_are_held(settings, tmp_path):
    """An hour of a robot with 29 joints has 5 GB."""
    arm = describe(load_section(ARM, RobotTable))
    numbers = Numbers(settings.free_motion, settings.plant, settings.rates)
    first = record_motion(arm, numbers, 0.05, 1, ideal=True, pushed=False)
    held = list[weakref.ref[Recording]]()

    def pieces():
        for _ in range(5):
            assert sum(one() is not None for one in held) < 2
            piece = replace(first)
            held.append(weakref.ref(piece))
            yield piece
            del piece

    told = write_log(pieces(), arm, tmp_path / "log.parquet", truth=False)
    assert told.samples == 5 * len(first.sensed)


def test_what_is_told_of_a_log_is_the_largest_of_all_its_pieces(settings, tmp_path):
    """The first piece moves most, by a motion in which the last one hardly moves."""
    arm = describe(load_section(ARM, RobotTable))
    numbers = Numbers(settings.free_motion, settings.plant, settings.rates)
    first = record_motion(arm, numbers, 0.5, 1, ideal=True, pushed=False)
    sensed = first.sensed
    still = replace(first, sensed=replace(sensed, v=0.1 * sensed.v, tau_motor=0.1 * sensed.tau_motor))
    told = write_log([still, first, still], arm, tmp_path / "log.parquet", truth=False)
    table = pd.read_parquet(tmp_path / "log.parquet")
    shares = [table[f"tau_motor.J{k}"].abs().max() / limit for k, limit in enumerate(arm.torque_limits, start=1)]
    assert told.speed == pytest.approx(table[["v.J1", "v.J2"]].abs().to_numpy().max(), abs=1e-6)
    assert told.share == pytest.approx(max(shares), abs=1e-6)
    assert min(told.speed, told.share) > 0.0
    assert list(report_lines(told, arm, 1000.0, tmp_path, truth=False))[1] == (
        f"largest speed {told.speed:.2f} rad/s, largest torque {told.share:.0%} of what its motor gives"
    )


@pytest.mark.parametrize(
    ("words", "message"),
    [
        (("--minutes", "0"), "--minutes: 0.0 is not accepted; accepted: above 0 and up to 60"),
        (("--minutes", "1e-6"), "--minutes: 1e-06 is not accepted; accepted: 1.7e-05 or more, a sample at 1000 Hz"),
        (("--seed", "0"), "--seed: 0 is not accepted; accepted: a whole number from 1 on"),
        (("--out", "log.bag"), "--out: ending: '.bag' is not accepted; accepted: .csv, .parquet"),
        (("--robot", "none.yaml"), "none.yaml"),
    ],
    ids=["minutes", "less than a sample", "seed", "ending", "robot"],
)
def test_what_is_not_accepted_is_one_line(words, message, say, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    status, lines = say(main, *words)
    assert (status, len(lines)) == (1, 1)
    assert message in lines[0]
    assert not list(tmp_path.iterdir())
