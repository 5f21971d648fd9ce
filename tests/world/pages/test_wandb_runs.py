"""All trainings as offline wandb runs."""

import contextlib
import os
import pty
import select
import shutil
import signal
import subprocess
import sys
import termios
import time
import unittest.mock
from collections.abc import Callable
from dataclasses import astuple
from pathlib import Path

import pytest
from patience import HANGS_S

from experiments.evaluation.report import wandb_runs as module
from experiments.evaluation.report.wandb_runs import wandb_runs
from experiments.records.scores import SCORES, Score
from mobnet.core.errors import DataError
from mobnet.core.files import write_text
from mobnet.core.rows import csv_text

EPOCHS = [",".join(map(str, (k, *(10.0 * k + i for i in range(1, 6))))) for k in (1, 2, 3)]

pytestmark = pytest.mark.slow


@pytest.fixture(scope="module")
def wandb_dir(tmp_path_factory: pytest.TempPathFactory, write_run: Callable[..., Path]) -> Path:
    """A folder into which two runs were written, and then once more the first of them alone."""
    root = tmp_path_factory.mktemp("wandb")
    networks = [write_run(root / "robot_1" / "networks", f"MOB-Net-LL-s{seed}", EPOCHS) for seed in (0, 1)]
    scores = root / "walk_test" / "robots.csv"
    rows = [Score("walk_test", "robots", "MOB-Net", 0, k, "LL", "avg", "rmse", 2.0 + k, "N m") for k in (0, 1)]
    write_text(scores, csv_text(SCORES, [astuple(row) for row in rows]))
    for rest in (networks, networks[:1]):
        wandb_runs(rest, [scores], root / "wandb")
    return root / "wandb"


def test_runs_written_again_take_the_place_of_all(wandb_dir: Path) -> None:
    (run,) = wandb_dir.iterdir()
    assert run.name.startswith("run-MOB-Net-LL-s0-")
    assert [path.name for path in run.iterdir()] == ["run-MOB-Net-LL-s0.wandb"]
    assert not list(wandb_dir.parent.glob(".partial.*"))


def test_a_run_of_which_wandb_left_no_file_is_logged_again(tmp_path, write_run, monkeypatch, caplog):
    logged = []

    def begin(scratch, name, *words):
        """Leave no file the first time."""
        logged.append(name)
        run = real(scratch, name, *words)
        if len(logged) == 1:
            for path in scratch.glob("wandb/offline-run-*/*.wandb"):
                path.unlink()
        return run

    real = module.begin
    monkeypatch.setattr(module, "begin", begin)
    wandb_runs([write_run(tmp_path, "MOB-Net-LL-s0", EPOCHS)], [], tmp_path / "wandb")
    assert logged == ["MOB-Net-LL-s0"] * 2
    assert [path.name for path in (tmp_path / "wandb").glob("*/*")] == ["run-MOB-Net-LL-s0.wandb"]
    assert "wandb made no file of the run MOB-Net-LL-s0" in caplog.text


@pytest.mark.parametrize(
    "fault", [OSError("no socket"), TimeoutError("no answer"), module.loaded(Path()).Error("busy")]
)
def test_a_run_at_which_wandb_fails_once_is_logged_again(tmp_path, write_run, monkeypatch, caplog, fault):
    logged = []

    def begin(scratch, name, *words):
        logged.append(name)
        if len(logged) == 1:
            raise fault
        return real(scratch, name, *words)

    real = module.begin
    monkeypatch.setattr(module, "begin", begin)
    wandb_runs([write_run(tmp_path, "MOB-Net-LL-s0", EPOCHS)], [], tmp_path / "wandb")
    assert logged == ["MOB-Net-LL-s0"] * 2
    assert f"{fault}; once more" in caplog.text


def test_a_full_disk_is_told_at_once_where_wandb_says_nothing_of_it(tmp_path, write_run, monkeypatch):
    logged = []

    def begin(scratch, name, *words):
        logged.append(name)
        return real(scratch, name, *words)

    def full(place):
        raise DataError(f"{place}: the disk is full")

    real = module.begin
    monkeypatch.setattr(module, "begin", begin)
    monkeypatch.setattr(module, "check_room", full)
    with pytest.raises(DataError, match="the disk is full"):
        wandb_runs([write_run(tmp_path, "MOB-Net-LL-s0", EPOCHS)], [], tmp_path / "wandb")
    assert len(logged) == 1


def test_a_folder_in_which_wandb_still_writes_is_no_fault(tmp_path, write_run, monkeypatch):
    """Removing it would fail; it goes when wandb's process has ended."""

    def remove(folder, ignore_errors=False, **words):
        if Path(folder).name.startswith("offline-run-"):
            if not ignore_errors:
                raise OSError(39, "Directory not empty", str(folder))
        else:
            real(folder, ignore_errors, **words)

    real = shutil.rmtree
    monkeypatch.setattr(module.shutil, "rmtree", remove)
    wandb_runs([write_run(tmp_path, "MOB-Net-LL-s0", EPOCHS)], [], tmp_path / "wandb")
    assert [path.name for path in (tmp_path / "wandb").glob("*/*")] == ["run-MOB-Net-LL-s0.wandb"]


def test_a_run_of_which_wandb_never_makes_a_file_is_one_line(tmp_path, write_run, monkeypatch):
    monkeypatch.setattr(module, "begin", lambda *words: contextlib.nullcontext(unittest.mock.MagicMock()))
    with pytest.raises(DataError, match=r"wandb made no file of the run MOB-Net-LL-s0; accepted: the same call again"):
        wandb_runs([write_run(tmp_path, "MOB-Net-LL-s0", EPOCHS)], [], tmp_path / "wandb")
    assert not (tmp_path / "wandb").exists()


def test_a_run_holds_settings_and_results(wandb_dir: Path) -> None:
    (run,) = wandb_dir.iterdir()
    words = (sys.executable, "-m", "wandb", "leet", "inspect", "--summary", str(run))
    shown = subprocess.run(words, env=quiet(wandb_dir), capture_output=True, text=True, check=True).stdout
    summary, config = ({" ".join(line.split()) for line in part.splitlines()} for part in shown.split("\nconfig\n"))
    assert {"parameters 83712", "best.epoch 1", "validation_rmse 33", "epoch 3"} <= summary
    assert {"test walk_test, robots", "test_rmse 2.5"} <= summary
    assert {"robot robot_1", "method MOB-Net", "limb LL", "seed 0"} <= config
    assert {"settings.network.cell GRU", "provenance.commit c"} <= config
    assert not any("parameters" in line for line in config)


def test_the_terminal_viewer_opens_the_folder(wandb_dir: Path) -> None:
    """Given a folder, wandb's viewer lists its runs and draws the last one's curves."""
    master, slave = pty.openpty()
    termios.tcsetwinsize(slave, (50, 160))
    words = (sys.executable, "-m", "wandb", "leet", str(wandb_dir))
    ends = dict.fromkeys(("stdin", "stdout", "stderr"), slave)
    with subprocess.Popen(words, **ends, env=quiet(wandb_dir), start_new_session=True) as viewer:
        shown, end = b"", time.monotonic() + HANGS_S
        while b"validation_rmse" not in shown and time.monotonic() < end:
            if select.select([master], [], [], 0.1)[0]:
                shown += os.read(master, 1 << 16)
        os.killpg(viewer.pid, signal.SIGTERM)
    os.close(master)
    os.close(slave)
    assert b"run-MOB-Net-LL-s0-" in shown
    assert b"validation_rmse" in shown


def quiet(folder: Path) -> dict[str, str]:
    """Return an environment in which wandb keeps its own files in a folder."""
    places = dict.fromkeys(("WANDB_CACHE_DIR", "WANDB_CONFIG_DIR", "WANDB_DATA_DIR"), str(folder.parent / "own"))
    return {**os.environ, **places, "WANDB_MODE": "offline", "TERM": "xterm-256color"}
