"""Trainings as they were written: sizes from run.json, losses from metrics.csv, and errors in tests from scores."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from math import isclose
from operator import attrgetter
from pathlib import Path
from statistics import fmean
from typing import Annotated, Any, Literal

import numpy as np
import pandas as pd
from pydantic import Field

from experiments.evaluation.number.frames import NETWORKS, TRAININGS, read_scores, rows_of, typed
from experiments.evaluation.number.laws import Law
from experiments.evaluation.number.number import Number
from experiments.intervals.crossed import RunGrid, summarise
from experiments.settings.figures import Figure17
from experiments.settings.runs import Statistics
from mobnet.core.epochs import Epoch, read_epochs
from mobnet.core.errors import not_accepted, refuse
from mobnet.core.files import METRICS, RUN, TIME, read_json
from mobnet.core.notes import Count, FileName, Index, Names, Note, NotNegative, Positive, Text, read_note
from mobnet.formats.network import CellKind
from mobnet.formats.robot import GroupName

MEASURES: Mapping[str, tuple[str, str]] = {  # name -> column of `NETWORKS` and unit
    "validation loss": ("validation_loss", "-"),
    "validation RMSE": ("validation_rmse", "N m"),
    "validation loss on windows": ("windows_loss", "-"),
    "training loss at the end": ("last_train_loss", "-"),
    "validation loss at the end": ("last_validation_loss", "-"),
}

DIGITS = 1e-6  # relative difference of a number that was written twice
Row = list[float]
Share = Annotated[float, Field(ge=0, le=1)]
TRAINED = ["method", "limb", "seed"]  # what names a network among scores


class NotedNetwork(Note):
    """The network that was trained."""

    cell: CellKind


class NotedSettings(Note):
    """Settings of a training; `epochs` is how many there are if it does not diverge.

    An epoch has all samples of the training, or `epoch_samples`.
    """

    epochs: Count
    epoch_samples: Count | None = None
    network: NotedNetwork


class NotedEpoch(Note):
    """The epoch whose weights are kept."""

    epoch: Count
    validation_loss: float
    validation_rmse: NotNegative | None = None


class OnWindows(Note):
    """Errors where the network runs through a window from a zero state for every sample."""

    loss: float
    rmse: NotNegative


class NotedFit(Note):
    """How well n standard deviations fit: coverage of k shares (k, n), likelihood and CRPS (n,)."""

    coverage: list[list[Share]]
    nll: Row
    crps: list[NotNegative]


class NotedCalibration(Note):
    """Factors on the standard deviations of n joints, and how well these fit before and after."""

    joints: Names
    shares: Annotated[list[Share], Field(min_length=1)]
    scale: list[Positive]
    likelihood_scale: list[Positive]
    before: NotedFit
    after: NotedFit


class TrainingNote(Note):
    """The note of a training, `run.json`; one that diverged in its first epoch has no best one."""

    name: FileName
    method: Text
    limb: GroupName
    seed: Index
    target: Literal["uncertainty", "external"]
    settings: NotedSettings
    parameters: Count
    samples: Count
    diverged: bool
    chosen_by: Literal["validation_loss", "validation_rmse"]
    best: NotedEpoch | None
    on_windows: OnWindows
    calibration: NotedCalibration
    device: Literal["cpu", "cuda"]
    precision: Literal["float32", "bfloat16"]
    fingerprint: Text
    provenance: dict[str, Any]


@dataclass(frozen=True)
class TrainedNetwork:
    """One trained network, with its parameters (column `Network Size` of Table 1).

    The samples are those learned from, without those held out; an epoch has `epoch_samples` of them. A training that
    diverged was stopped as its loss grew; its epochs end there. `windows_loss` is the validation loss (22) of the epoch
    kept if the network starts from a zero state a window before every sample; for all other losses its state is
    carried from sample to sample. `joint_errors` are joint -> its RMSE of each epoch [N, N m]; a training of an earlier
    version has none.
    """

    method: str
    seed: int
    parameters: int
    samples: int
    diverged: bool
    windows_loss: float
    chosen_by: str
    epoch_samples: int
    epochs: tuple[Epoch, ...]
    joint_errors: Mapping[str, Sequence[float]]

    @property
    def steps(self) -> int:
        """Number of time steps that the network has seen in training."""
        return len(self.epochs) * self.epoch_samples

    @property
    def last(self) -> Epoch:
        """The last epoch."""
        return self.epochs[-1]

    @property
    def kept(self) -> Epoch:
        """The epoch that validated best, whose weights are kept."""
        return min(self.epochs, key=attrgetter("stride", self.chosen_by))


def read_test_errors(scores: Sequence[Path]) -> pd.DataFrame:
    """Return the error of each network's estimates in the first of some files of scores that has it.

    Returns:
        Columns `TRAINED`, which name the network; the `test`, scenario and level; and the `rmse`, a mean over walks
        [N m; N of the base's forces].

    Raises:
        DataError: a file is missing or damaged.
    """
    parts: list[pd.DataFrame] = []
    for path in scores:
        errors = rows_of(read_scores(path), metric="rmse", joint="avg").rename(columns={"network_seed": "seed"})
        means = errors.groupby(TRAINED, sort=False)["value"].mean().rename("rmse")
        parts.append(means.reset_index().assign(test=f"{path.parent.name}, {path.stem}"))
    every = pd.concat(parts) if parts else pd.DataFrame(columns=[*TRAINED, "rmse", "test"])
    # The first file that has a network counts, so that later ones only add others.
    return every.drop_duplicates(TRAINED)


def error_in_test(tested: pd.DataFrame, note: Mapping[str, Any]) -> tuple[str, float | None]:
    """Return the test of a network, which the note of its training names, and its error there; "" and None of none."""
    rows = rows_of(tested, **{name: note[name] for name in TRAINED}).to_dict("records")
    return (rows[0]["test"], rows[0]["rmse"]) if rows else ("", None)


def robot_of(folder: Path) -> str:
    """Return the name of the plant or robot whose folder has that of a network, or of its checkpoint."""
    return folder.parent.parent.name


def read_training(folder: Path) -> TrainedNetwork:
    """Read a network's folder.

    Raises:
        DataError: a file is missing or damaged, or they do not agree, one line for each fault.
    """
    note = read_training_note(folder)
    (epochs, errors) = read_epochs(folder / METRICS)
    refuse(folder, [*_disagreements(note, epochs), *_errors_apart(note, epochs, errors)])
    return TrainedNetwork(
        note.method, note.seed, note.parameters, note.samples, note.diverged, note.on_windows.loss, note.chosen_by,
        note.settings.epoch_samples or note.samples, epochs, errors,
    )  # fmt: skip


def read_training_note(folder: Path) -> TrainingNote:
    """Read the note of a network's folder.

    Raises:
        DataError: it is missing or damaged, or a key or a value is not accepted; one line for each.
    """
    note = read_note(folder / RUN, TrainingNote)
    refuse(folder / RUN, _calibration_faults(note.calibration))
    return note


def training_seconds(folder: Path) -> float | None:
    """Return the processor time of the training of a network's folder [s]; None where it was not trained here."""
    time = folder.parent.with_name("state") / folder.name / TIME  # beside the training's checkpoint
    return read_json(time)["seconds"] if time.is_file() else None


def _disagreements(note: TrainingNote, epochs: Sequence[Epoch]) -> Iterator[str]:
    """Yield where the epochs are not what the note says: how many, and which one is kept."""
    count = note.settings.epochs
    if (not note.diverged and len(epochs) != count) or len(epochs) > count:
        yield _apart("epochs", len(epochs), count)
    kept = min(epochs, key=attrgetter("stride", note.chosen_by), default=None)
    noted = note.best.epoch if note.best else None
    if noted != (kept.epoch if kept else None):
        yield _apart(f"epoch of the smallest {note.chosen_by}", kept and kept.epoch, noted)
    for name in ("validation_loss", "validation_rmse") if note.best and kept and noted == kept.epoch else ():
        said = getattr(note.best, name)
        written = getattr(kept, name)
        if said is not None and not isclose(said, written, rel_tol=DIGITS):
            yield _apart(f"{name} of epoch {noted}", written, said)


def _errors_apart(note: TrainingNote, epochs: Sequence[Epoch], errors: Mapping[str, Sequence[float]]) -> Iterator[str]:
    """Yield joints that are not the note's, and the first epoch whose error is not the mean over the joints."""
    joints = note.calibration.joints
    if errors and list(errors) != list(joints):
        yield _apart("joints with errors", ", ".join(errors), ", ".join(joints))
    for epoch, errors_of_joints in zip(epochs, zip(*errors.values(), strict=True), strict=False):
        if not isclose(fmean(errors_of_joints), epoch.validation_rmse, rel_tol=DIGITS):
            yield f"validation_rmse of epoch {epoch.epoch}: " + not_accepted(
                METRICS, epoch.validation_rmse, [f"the mean over the joints, {fmean(errors_of_joints):.6g}"]
            )
            return


def _apart(what: str, written: object, said: object) -> str:
    """Return the message that the two files of a training differ; which of them is wrong nobody can tell."""
    return f"{what}: {written} in {METRICS} and {said} in {RUN} are not accepted; accepted: the same in both"


def _calibration_faults(noted: NotedCalibration) -> Iterator[str]:
    """Yield lists that are not as long as there are joints or shares, and wide intervals that contain less."""
    joints = len(noted.joints)
    shares = len(noted.shares)
    fits = {"before": noted.before, "after": noted.after}
    lists: dict[str, Sequence[object]] = {"scale": noted.scale, "likelihood_scale": noted.likelihood_scale}
    for when, fit in fits.items():
        lists |= {f"{when}.nll": fit.nll, f"{when}.crps": fit.crps}
    for when, fit in fits.items():
        lists |= {f"{when}.coverage.{k}": row for k, row in enumerate(fit.coverage)}
    for name, values in lists.items():
        if len(values) != joints:
            yield not_accepted(f"calibration.{name}", values, [f"{joints} numbers, one for each joint"])
    for when, fit in fits.items():
        if len(fit.coverage) != shares:
            yield not_accepted(f"calibration.{when}.coverage", fit.coverage, [f"{shares} rows, one for each share"])
        for joint, contained in zip(noted.joints, zip(*fit.coverage, strict=False), strict=False):
            if list(contained) != sorted(contained):
                accepted = [f"shares of {joint} that grow with {noted.shares}"]
                yield not_accepted(f"calibration.{when}.coverage", list(contained), accepted)


def read_trainings(folders: Iterable[Path]) -> tuple[pd.DataFrame, pd.DataFrame]:
    """Read trained networks: columns `NETWORKS`, and their epochs, columns `TRAININGS`; both in the order given.

    Raises:
        DataError: a file is missing or damaged, or files do not agree; one line for each fault.
    """
    networks: list[dict[str, Any]] = []
    epochs: list[dict[str, Any]] = []
    for folder in folders:
        training = read_training(folder)
        row = {name: getattr(training, name) for name in NETWORKS if hasattr(training, name)}
        if training.epochs:
            kept, last = training.kept, training.last
            row |= {name: getattr(kept, name) for name in ("stride", "validation_loss", "validation_rmse")}
            row |= {f"last_{name}": getattr(last, name) for name in ("train_loss", "validation_loss")}
        networks.append(row)
        epochs += [{**row, **vars(epoch)} for epoch in training.epochs]
    return typed(networks, NETWORKS), typed(epochs, TRAININGS)


def over_networks(column: str, unit: str, statistics: Statistics) -> Law:
    """Return the law of the mean of a column [unit] of networks, each on one walk; there is none without a network."""

    def law(networks: pd.DataFrame) -> Number:
        if networks.empty:
            return Number(None, unit=unit)
        return summarise([RunGrid(networks[[column]].to_numpy(dtype=np.float64))], statistics, unit=unit)

    return law


def kind_of_each(settings: Figure17) -> dict[str, str]:
    """Return each method of Figure 17 -> its kind, which has the name of the method that is best of it."""
    kinds = dict(zip(settings.methods, settings.best, strict=True))
    return kinds | {best: best for best in settings.best}
