"""All trainings as offline wandb runs."""

from __future__ import annotations

import os
import pty
import select
import signal
import subprocess
import sys
import termios
import time
from dataclasses import asdict
from pathlib import Path
from typing import Any

import pytest

from mobnet.core.files import write_json
from mobnet.evaluation.measure.trainings import Epoch
from mobnet.evaluation.number.rows import write_rows
from mobnet.evaluation.report.wandb_runs import wandb_runs

EPOCHS = [Epoch(k, *(10.0 * k + i for i in range(1, 6))) for k in (1, 2, 3)]
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
    "best": asdict(EPOCHS[1]),
    "seconds": 227.7,
}
TERMINAL_S = 20


@pytest.fixture(scope="module")
def wandb_dir(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder into which two runs were written, and once more with another training's network gone."""
    root = tmp_path_factory.mktemp("wandb")
    networks = [root / name for name in ("MOB-Net-LL-s0", "MOB-Net-LL-s1")]
    for network in networks:
        write_rows(network / "metrics.csv", Epoch, EPOCHS)
        write_json(network / "run.json", NOTE | {"name": network.name})
    for rest in (networks, networks[:1]):
        wandb_runs(rest, root / "wandb")
    return root / "wandb"


@pytest.mark.slow
def test_runs_written_again_take_the_place_of_all(wandb_dir: Path) -> None:
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
