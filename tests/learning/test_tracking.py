"""metrics.csv and the offline wandb run."""

from __future__ import annotations

import csv
import os
import pty
import select
import signal
import subprocess
import sys
import termios
import time
from pathlib import Path
from typing import Any

import pytest

from mobnet.learning.tracking import COLUMNS, write_metrics, write_wandb

ROWS = [{name: float(10 * epoch + i) for i, name in enumerate(COLUMNS)} | {"epoch": epoch} for epoch in (1, 2, 3)]
NOTE: dict[str, Any] = {
    "name": "MOB-Net-LL-s0",
    "method": "MOB-Net",
    "limb": "LL",
    "seed": 0,
    "target": "uncertainty",
    "settings": {"epochs": 3, "network": {"cell": "GRU"}},
    "fingerprint": "19d24124e221260e",
    "provenance": {"commit": "21b3510"},
    "parameters": 83712,
    "best": ROWS[1],
    "seconds": 227.7,
}
TERMINAL_S = 20


@pytest.fixture(scope="module")
def wandb_dir(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder into which the same run was written twice."""
    folder = tmp_path_factory.mktemp("wandb")
    for _ in range(2):
        write_wandb(folder, NOTE, ROWS)
    return folder


def test_metrics_come_back_as_written(tmp_path: Path) -> None:
    """Writing and reading are a round trip."""
    write_metrics(tmp_path / "metrics.csv", ROWS)
    with (tmp_path / "metrics.csv").open() as file:
        read = [{name: float(value) for name, value in row.items()} for row in csv.DictReader(file)]
    assert read == ROWS


@pytest.mark.slow
def test_a_run_written_again_takes_its_place(wandb_dir: Path) -> None:
    (run,) = wandb_dir.iterdir()
    assert run.name.endswith("-MOB-Net-LL-s0")
    assert (run / "run-MOB-Net-LL-s0.wandb").is_file()


@pytest.mark.slow
def test_a_run_holds_settings_and_results(wandb_dir: Path) -> None:
    (run,) = wandb_dir.iterdir()
    words = (sys.executable, "-m", "wandb", "leet", "inspect", "--summary", str(run))
    shown = subprocess.run(words, env=quiet(wandb_dir), capture_output=True, text=True, check=True).stdout
    summary, config = shown.split("\nconfig\n")
    lines = [" ".join(line.split()) for line in summary.splitlines()]
    assert {"parameters 83712", "seconds 227.7", "best.epoch 2", "best.validation_rmse 23", "epoch 3"} <= set(lines)
    lines = [" ".join(line.split()) for line in config.splitlines()]
    assert {"limb LL", "settings.network.cell GRU", "provenance.commit 21b3510"} <= set(lines)
    assert "seconds" not in config


@pytest.mark.slow
def test_the_terminal_viewer_opens_the_folder(wandb_dir: Path) -> None:
    """Given a folder, wandb's viewer lists its runs and draws the last one's curves."""
    master, slave = pty.openpty()
    termios.tcsetwinsize(slave, (50, 160))
    words = (sys.executable, "-m", "wandb", "leet", str(wandb_dir))
    ends = dict.fromkeys(("stdin", "stdout", "stderr"), slave)
    with subprocess.Popen(words, **ends, env=quiet(wandb_dir), start_new_session=True) as viewer:
        shown, end = b"", time.monotonic() + TERMINAL_S
        while b"validation_rmse" not in shown and time.monotonic() < end:
            if select.select([master], [], [], 0.1)[0]:
                shown += os.read(master, 1 << 16)
        os.killpg(viewer.pid, signal.SIGTERM)
    os.close(master)
    os.close(slave)
    assert b"MOB-Net-LL-s0" in shown
    assert b"validation_rmse" in shown


def quiet(folder: Path) -> dict[str, str]:
    """Return an environment in which wandb keeps its own files in a folder."""
    places = dict.fromkeys(("WANDB_CACHE_DIR", "WANDB_CONFIG_DIR", "WANDB_DATA_DIR"), str(folder.parent / "own"))
    return {**os.environ, **places, "WANDB_MODE": "offline", "TERM": "xterm-256color"}
