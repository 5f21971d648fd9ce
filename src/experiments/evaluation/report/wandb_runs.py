"""All trainings as offline wandb runs, made from run.json and metrics.csv; nothing leaves the machine.

They are written when the trainings are done and tested; what goes on is in the folder of `wandb_live`.
"""

import logging
import os
import shutil
import tempfile
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import asdict
from pathlib import Path
from typing import TYPE_CHECKING, Any

import pandas as pd

from experiments.evaluation.measure.learning.trainings import error_in_test, read_test_errors, read_training, robot_of
from mobnet.core.epochs import Epoch
from mobnet.core.errors import DataError
from mobnet.core.files import PARTIAL, RUN, check_room, read_json

if TYPE_CHECKING:
    from wandb import Run

SETTINGS = ("name", "method", "limb", "seed", "target", "settings", "fingerprint", "provenance")  # keys of run.json
# `wandb leet` lists only folders whose names start with `run-` and have a date before the run's identifier. Of a name
# it shows the first 29 characters, so that the run's name comes first. The date is fixed: equal runs have equal names.
FOLDER = "run-{0}-run-00000000_000000-{0}"
WANDB_PLACES = ("WANDB_CACHE_DIR", "WANDB_DATA_DIR", "WANDB_CONFIG_DIR")
FLUSH_S = 1.0  # after which a viewer finds what was logged
TRIALS = 3  # to log a run

log = logging.getLogger(__name__)


def wandb_runs(folders: Iterable[Path], scores: Sequence[Path], out: Path) -> None:
    """Write one offline run for each network, a file in a folder; they replace the folder of runs together.

    Of the `scores`, the first file that has a network gives its error in a test.

    Raises:
        DataError: the disk is full, or wandb leaves no file.
    """
    tested = read_test_errors(scores)
    out.parent.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(prefix=PARTIAL, suffix=f".{out.name}", dir=out.parent) as scratch:
        runs = Path(scratch) / "runs"
        runs.mkdir()
        for folder in folders:
            _log_again(Path(scratch), folder, tested, runs)
        loaded(Path(scratch)).teardown()  # until its process ends, that writes into the folder which is removed now
        if out.exists():
            os.replace(out, Path(scratch) / "old")
        os.replace(runs, out)


def _log_again(scratch: Path, folder: Path, tested: pd.DataFrame, runs: Path) -> None:
    """Log a training into a run among others, again where wandb fails or leaves no file: seen on a busy machine.

    Raises:
        DataError: the disk is full, or wandb fails or leaves no file each time.
    """
    for trial in range(1, TRIALS + 1):
        fault: Exception | None = None
        try:
            made = put(scratch, _log_run(scratch, folder, tested), runs)
            shutil.rmtree(made.parent, ignore_errors=True)  # where its process still writes, this goes in the end
        except (DataError, OSError, loaded(scratch).Error) as error:
            fault = error
        check_room(runs)  # wandb may write a part of a file and say nothing
        if fault is None:
            return
        if trial == TRIALS:
            raise DataError(f"{folder}: {fault}") from fault
        log.warning("%s; once more", fault)


def _log_run(scratch: Path, folder: Path, tested: pd.DataFrame) -> str:
    """Log a training into a run below the scratch folder, and return its name.

    The robot and the keys SETTINGS of its note become the run's configuration, all others its summary, which ends with
    the error in a test. Runs are grouped by method, and the limb is their type of job.
    """
    training = read_training(folder)
    note = read_json(folder / RUN)
    settings = {"robot": robot_of(folder), **{key: note[key] for key in SETTINGS}}
    with begin(scratch, note["name"], note["method"], note["limb"], settings) as run:
        for row in rows(training.epochs, training.joint_errors):
            run.log(row, step=row["epoch"])
        run.summary.update({key: value for key, value in note.items() if key not in SETTINGS})
        test, rmse = error_in_test(tested, note)
        if rmse is not None:
            run.summary.update({"test": test, "test_rmse": rmse})
    return note["name"]


def begin(scratch: Path, name: str, method: str, limb: str, settings: Mapping[str, Any]) -> "Run":
    """Begin an offline run below the scratch folder, beside others that go on."""
    wandb = loaded(scratch)
    # Nothing of this machine goes into a run: two runs of the same results have the same files.
    quiet = wandb.Settings(
        x_disable_stats=True,
        x_disable_meta=True,
        x_disable_machine_info=True,
        x_save_requirements=False,
        console="off",
        silent=True,
        disable_git=True,
        disable_code=True,
        x_transaction_log_flush_interval=FLUSH_S,
    )
    return wandb.init(
        project="mobnet",
        id=name,
        name=name,
        group=method,
        job_type=limb,
        config=dict(settings),
        dir=scratch,
        mode="offline",
        settings=quiet,
        reinit="create_new",
    )


def loaded(scratch: Path) -> Any:
    """Return the package wandb, whose own files go into a scratch folder: it reads its environment when imported."""
    os.environ |= dict.fromkeys(WANDB_PLACES, str(scratch)) | {"WANDB_ERROR_REPORTING": "false"}
    import wandb

    return wandb


def rows(epochs: Sequence[Epoch], errors: Mapping[str, Sequence[float]]) -> Iterator[dict[str, Any]]:
    """Yield what is logged of each epoch: its columns, and the RMSE of each joint [N, N m]."""
    for k, epoch in enumerate(epochs):
        yield asdict(epoch) | {f"joints/{joint}": own[k] for joint, own in errors.items()}


def put(scratch: Path, name: str, runs: Path) -> Path:
    """Move the file of a run into a folder of its name among other runs, in place of an older one.

    A run that goes on still writes to it. Return where it stood.

    Raises:
        DataError: wandb has made no such file.
    """
    found = next((scratch / "wandb").glob(f"offline-run-*/run-{name}.wandb"), None)
    if found is None:
        raise DataError(f"wandb made no file of the run {name}; accepted: the same call again")
    place = runs / FOLDER.format(name)
    place.mkdir(parents=True, exist_ok=True)
    os.replace(found, place / found.name)
    return found
