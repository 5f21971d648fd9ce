"""What a training run leaves to look at: metrics.csv, which is the truth, and an offline wandb run, a view of it."""

from __future__ import annotations

import csv
import io
import os
import shutil
import tempfile
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

from mobnet.core.files import write_text
from mobnet.learning.checkpoint import Row

METRICS = "metrics.csv"
COLUMNS = ("epoch", "train_loss", "validation_loss", "validation_rmse", "rate", "gradient_norm")
SETTINGS = ("name", "method", "limb", "seed", "target", "settings", "fingerprint", "provenance")  # keys of run.json
DATED = "run-00000000_000000-"  # `wandb leet` opens only folders named by date; none, so that a rerun takes its place
WANDB_PLACES = ("WANDB_CACHE_DIR", "WANDB_DATA_DIR", "WANDB_CONFIG_DIR")


def write_metrics(path: Path, rows: Sequence[Row]) -> None:
    """Write one line per epoch: losses of (22) unitless, RMSE [N, N m], rate and gradient norm [-]; atomic."""
    text = io.StringIO()
    writer = csv.DictWriter(text, COLUMNS, lineterminator="\n")
    writer.writeheader()
    writer.writerows({name: row[name] for name in COLUMNS} for row in rows)
    write_text(path, text.getvalue())


def write_wandb(folder: Path, note: Mapping[str, Any], rows: Sequence[Row]) -> Path:
    """Write an offline wandb run of a finished training; nothing leaves the machine.

    A run is written at the end in one go: offline runs cannot be resumed, and a training can.

    Args:
        folder: where the runs lie.
        note: what `run.json` tells; SETTINGS become the run's configuration, all else its summary. Runs are grouped by
            method, and the limb is their type of job.
        rows: metrics of each epoch.

    Returns:
        The run's folder, which ends in the run's name.
    """
    folder.mkdir(parents=True, exist_ok=True)
    target = folder / f"{DATED}{note['name']}"
    with tempfile.TemporaryDirectory(prefix=".scratch-", dir=folder) as scratch:
        _log_run(scratch, note, rows)
        (run,) = (Path(scratch) / "wandb").glob("offline-run-*")
        shutil.rmtree(target, ignore_errors=True)
        os.replace(run, target)
    return target


def _log_run(scratch: str, note: Mapping[str, Any], rows: Sequence[Row]) -> None:
    """Log settings, epochs and results into a run below the scratch folder."""
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
        for row in rows:
            run.log(dict(row), step=int(row["epoch"]))
        run.summary.update({key: value for key, value in note.items() if key not in SETTINGS})
