"""Offline wandb runs of trainings that are under way."""

import json
import os
import signal
import subprocess
import sys
from collections.abc import Callable, Iterator
from pathlib import Path

import psutil
import pytest
from browser import wait

from experiments.evaluation.report.wandb_live import RUNS, Follower
from experiments.evaluation.report.wandb_runs import FOLDER, wandb_runs
from mobnet.core.epochs import JOINT_ERROR

NAME = "MOB-Net-LL-s0"
HEAD = "epoch,train_loss,validation_loss,validation_rmse,rate,gradient_norm,stride"
JOINTS = ("LL1", "LL2")
IMPORTS = "import sys, time; from pathlib import Path"
STARTS = f"{IMPORTS}; from experiments.running.processes import follow_trainings as follow;"

pytestmark = pytest.mark.slow


@pytest.fixture
def followed(tmp_path: Path) -> Iterator[Follower]:
    """A follower of the results in a folder."""
    follower = follower_of(tmp_path)
    yield follower
    follower.close()


def follower_of(results: Path) -> Follower:
    (results / ".partial").mkdir(exist_ok=True)
    return Follower(results, results / ".partial")


def train(results: Path, epochs: int, robot: str = "plant", *, done: bool = False) -> Path:
    """Write what a training has written after some epochs; of the checkpoint only its time counts."""
    state = results / robot / "state" / NAME
    state.mkdir(parents=True, exist_ok=True)
    joints = [JOINT_ERROR.format(joint) for joint in JOINTS]
    rows = [f"{k},{-k},{-k - 1},{3.0 / k},0.01,9,1,{2.0 / k},{4.0 / k}" for k in range(1, epochs + 1)]
    (state / "metrics.csv").write_text("\n".join([",".join([HEAD, *joints]), *rows, ""]))
    (state / "checkpoint.safetensors").write_bytes(b"")
    if done:
        (state / "checkpoint.safetensors").unlink()
    return state


def shown(results: Path, *words: str) -> str:
    """Return what wandb's viewer says of the run."""
    places = dict.fromkeys(("WANDB_CACHE_DIR", "WANDB_CONFIG_DIR", "WANDB_DATA_DIR"), str(results / "own"))
    asked = [sys.executable, "-m", "wandb", "leet", "inspect", *words, str(results / RUNS / FOLDER.format(NAME))]
    out = subprocess.run(asked, env={**os.environ, **places}, capture_output=True, text=True, check=False).stdout
    return "\n".join(" ".join(line.split()) for line in out.splitlines())


def test_a_training_shows_while_it_goes_on_and_ends(tmp_path: Path, followed: Follower) -> None:
    train(tmp_path, 2)
    followed.look()
    assert wait(lambda: "epoch 2" in shown(tmp_path, "--summary"))
    said = shown(tmp_path, "--summary").splitlines()
    assert {
        "joints/LL1 1",
        "joints/LL2 2",
        "validation_rmse 1.5",
        "robot plant",
        "method MOB-Net",
        "limb LL",
        "seed 0",
    } <= set(said)
    assert not any(line.startswith("state finished") for line in said)
    train(tmp_path, 3, done=True)
    followed.look()
    assert {"state finished (exit code 0)", "epoch 3"} <= set(shown(tmp_path, "--summary").splitlines())


def test_networks_that_learn_side_by_side_show_each(tmp_path: Path, followed: Follower) -> None:
    """They share one checkpoint; the folder of the stack itself is no training."""
    stack = tmp_path / "plant" / "state" / f"plant-{NAME}"
    stack.mkdir(parents=True)
    (stack / "members.json").write_text(json.dumps({"folders": [str(train(tmp_path, 2, done=True))]}))
    (stack / "checkpoint.safetensors").write_bytes(b"")
    followed.look()
    assert wait(lambda: "epoch 2" in shown(tmp_path, "--summary"))
    assert not any(line.startswith("state finished") for line in shown(tmp_path, "--summary").splitlines())
    (stack / "checkpoint.safetensors").unlink()
    followed.look()
    assert "state finished (exit code 0)" in shown(tmp_path, "--summary").splitlines()
    assert [path.name for path in (tmp_path / RUNS).iterdir()] == [FOLDER.format(NAME)]


def test_a_training_that_goes_on_after_a_kill_is_logged_from_its_first_epoch(tmp_path: Path) -> None:
    for epochs in (2, 4):
        follower = follower_of(tmp_path)
        train(tmp_path, epochs)
        follower.look()
        follower.close()
    assert [path.name for path in (tmp_path / RUNS).iterdir()] == [FOLDER.format(NAME)]
    records = [json.loads(line) for line in shown(tmp_path, "--json").splitlines()]
    steps = [record["history"]["step"]["num"] for record in records if record.get("type") == "history"]
    assert steps == [1, 2, 3, 4]


def test_a_training_that_began_afresh_has_a_new_run(tmp_path: Path, followed: Follower) -> None:
    for epochs in (3, 1):
        train(tmp_path, epochs)
        followed.look()
    assert wait(lambda: "epoch 1" in shown(tmp_path, "--summary"))


def test_a_checkpoint_that_an_earlier_run_left_is_no_training(tmp_path: Path) -> None:
    train(tmp_path, 2)
    follower = follower_of(tmp_path)
    follower.look()
    assert not (tmp_path / RUNS).exists()


def test_damaged_metrics_stop_only_their_own_run(tmp_path: Path, followed: Follower) -> None:
    (train(tmp_path, 2) / "metrics.csv").rename(tmp_path / "kept")
    train(tmp_path, 2, "robot_1")
    followed.look()
    assert (tmp_path / RUNS / FOLDER.format(NAME)).is_dir()


def test_runs_that_go_on_and_those_of_finished_trainings_do_not_touch_each_other(
    tmp_path: Path, followed: Follower, write_run: Callable[..., Path]
) -> None:
    train(tmp_path, 2)
    followed.look()
    followed.close()
    wandb_runs([write_run(tmp_path / "networks", NAME, ["1,-1,-1,4,.1,9"])], [], tmp_path / "wandb")
    assert [path.name for path in (tmp_path / "wandb").iterdir()] == [FOLDER.format(NAME)]
    assert "epoch 2" in shown(tmp_path, "--summary")


def test_the_process_ends_with_a_killed_run(tmp_path: Path) -> None:
    places = f"Path({str(tmp_path)!r}), Path({str(tmp_path / 'log')!r})"
    script = f"{STARTS} print(follow(sys.executable, {places}).pid, flush=True);"
    with subprocess.Popen([sys.executable, "-c", f"{script} time.sleep(600)"], stdout=subprocess.PIPE) as run:
        assert run.stdout is not None
        process = psutil.Process(int(run.stdout.readline()))
        wait(lambda: list(tmp_path.glob(".partial.*")))  # it has begun
        train(tmp_path, 1)
        assert wait(lambda: (tmp_path / RUNS).exists())
        run.send_signal(signal.SIGKILL)
    assert wait(lambda: not process.is_running() or process.status() == psutil.STATUS_ZOMBIE)
    assert wait(lambda: not list(tmp_path.glob(".partial.*")))
    assert (tmp_path / "log").read_text() == ""
