"""All trainings as offline wandb runs, a view of what run.json and metrics.csv say; nothing leaves the machine.

They are written after the trainings, in one process: a training can be killed and resumed, which an offline run cannot,
and starting wandb takes as long as a tenth of a short training.
"""

from __future__ import annotations

import os
import shutil
import tempfile
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import asdict
from pathlib import Path
from typing import Any

from mobnet.core.files import read_json
from mobnet.evaluation.measure.trainings import METRICS, RUN, Epoch
from mobnet.evaluation.number.rows import read_rows

SETTINGS = ("name", "method", "limb", "seed", "target", "settings", "fingerprint", "provenance")  # keys of run.json
DATED = "run-00000000_000000-"  # `wandb leet` opens only folders named by date; none, so that a rerun takes its place
WANDB_PLACES = ("WANDB_CACHE_DIR", "WANDB_DATA_DIR", "WANDB_CONFIG_DIR")


def wandb_runs(folders: Iterable[Path], out_dir: Path) -> None:
    """Write one offline run per network; what else lies in the folder of runs goes.

    Args:
        folders: networks' folders.
        out_dir: gets a folder per run, which ends in the run's name.

    Raises:
        DataError: a file is missing or damaged.
    """
    shutil.rmtree(out_dir, ignore_errors=True)
    out_dir.mkdir(parents=True)
    with tempfile.TemporaryDirectory(prefix=".scratch-", dir=out_dir) as scratch:
        for folder in folders:
            note = read_json(folder / RUN)
            _log_run(scratch, note, read_rows(folder / METRICS, Epoch))
            (run,) = (Path(scratch) / "wandb").glob("offline-run-*")
            os.replace(run, out_dir / f"{DATED}{note['name']}")


def _log_run(scratch: str, note: Mapping[str, Any], epochs: Sequence[Epoch]) -> None:
    """Log a training into a run below the scratch folder: SETTINGS as its configuration, all else as its summary.

    Runs are grouped by method, and the limb is their type of job.
    """
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
        for epoch in epochs:
            run.log(asdict(epoch), step=epoch.epoch)
        run.summary.update({key: value for key, value in note.items() if key not in SETTINGS})
