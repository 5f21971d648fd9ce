"""All trainings as offline wandb runs, made from run.json and metrics.csv; nothing leaves the machine.

They are written after the trainings, in one process: a training can be killed and resumed, an offline run cannot, and
starting wandb takes as long as a tenth of a short training.
"""

import os
import shutil
import tempfile
from collections.abc import Iterable
from dataclasses import asdict
from pathlib import Path

from mobnet.core.files import PARTIAL, RUN, check_room, read_json
from mobnet.evaluation.measure.learning.trainings import read_training

SETTINGS = ("name", "method", "limb", "seed", "target", "settings", "fingerprint", "provenance")  # keys of run.json
# `wandb leet` lists only folders whose names start with `run-` and have a date before the run's identifier. Of a name
# it shows the first 29 characters, so that the run's name comes first. The date is fixed: equal runs have equal names.
FOLDER = "run-{0}-run-00000000_000000-{0}"
WANDB_PLACES = ("WANDB_CACHE_DIR", "WANDB_DATA_DIR", "WANDB_CONFIG_DIR")


def wandb_runs(folders: Iterable[Path], out: Path) -> None:
    """Write one offline run for each network, a file in a folder; they replace the folder of runs together.

    Raises:
        DataError: the disk is full.
    """
    out.parent.mkdir(parents=True, exist_ok=True)
    with tempfile.TemporaryDirectory(prefix=PARTIAL, suffix=f".{out.name}", dir=out.parent) as scratch:
        runs = Path(scratch) / "runs"
        runs.mkdir()
        for folder in folders:
            try:
                name = _log_run(scratch, folder)
            finally:
                check_room(out.parent)
            place = runs / FOLDER.format(name)
            place.mkdir()
            (run,) = (Path(scratch) / "wandb").glob(f"offline-run-*/run-{name}.wandb")
            os.replace(run, place / run.name)
            shutil.rmtree(run.parent)
        shutil.rmtree(out, ignore_errors=True)
        os.replace(runs, out)


def _log_run(scratch: str, folder: Path) -> str:
    """Log a training into a run below the scratch folder, and return its name.

    The keys SETTINGS of its note become the run's configuration, all others its summary. Runs are grouped by method,
    and the limb is their type of job.
    """
    training, note = read_training(folder), read_json(folder / RUN)
    os.environ |= dict.fromkeys(WANDB_PLACES, scratch) | {"WANDB_ERROR_REPORTING": "false"}
    import wandb  # reads its environment when imported

    quiet = wandb.Settings(
        x_disable_stats=True, x_disable_meta=True, x_disable_machine_info=True, x_save_requirements=False,
        console="off", silent=True, disable_git=True, disable_code=True,
    )  # fmt: skip
    with wandb.init(
        project="mobnet", id=note["name"], name=note["name"], group=note["method"], job_type=note["limb"],
        config={key: note[key] for key in SETTINGS},
        dir=scratch, mode="offline", settings=quiet,
    ) as run:  # fmt: skip
        for epoch in training.epochs:
            run.log(asdict(epoch), step=epoch.epoch)
        run.summary.update({key: value for key, value in note.items() if key not in SETTINGS})
    return note["name"]
