"""The epochs of a training, as its `metrics.csv` has them."""

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, fields
from pathlib import Path

from mobnet.core.errors import refuse_lines
from mobnet.core.rows import parse_field, read_rows, read_texts, refuse_rows


@dataclass(frozen=True)
class Epoch:
    """One epoch of a training, counted from 1: a row of metrics.csv.

    Losses are means of (22) over the samples of the training, and over those held out; `validation_rmse` is the mean
    over the joints of their root-mean-square errors [N m], V1..V3 [N]; `gradient_norm` is the mean norm of the gradient
    before the clip; `stride` is the distance between two steps [samples], in training and validation. In the file, the
    errors of the joints follow, in columns of their own: JOINT_ERROR.
    """

    epoch: int
    train_loss: float
    validation_loss: float
    validation_rmse: float
    rate: float
    gradient_norm: float
    stride: int


EPOCHS = tuple(field.name for field in fields(Epoch))
JOINT_ERROR = "validation_rmse_{}"  # column of metrics.csv with the error of one joint [N m], V1..V3 [N]
Fault = tuple[int, str, object, str]  # number of a row, column, value, accepted


def read_epochs(path: Path) -> tuple[tuple[Epoch, ...], dict[str, tuple[float, ...]]]:
    """Read the epochs of a training, and joint -> its error in each of them (E,) [N, N m].

    A training of an earlier version has no errors of joints.

    Raises:
        DataError: the file is missing or damaged, or a row is not accepted; one line for each fault.
    """
    rows = read_rows(path, Epoch)
    refuse_rows(path, _epoch_faults(rows))
    return tuple(rows), _joint_errors(path)


def _joint_errors(path: Path) -> dict[str, tuple[float, ...]]:
    """Return joint -> its error in each epoch (E,) [N, N m], as read_epochs does."""
    faults = list[str]()
    errors = dict[str, tuple[float, ...]]()
    lines = [*enumerate(read_texts(path), start=2)]
    for name in lines[0][1] if lines else ():
        if name.startswith(prefix := JOINT_ERROR.format("")):
            values = [parse_field(row[name], float, f"{path}:{line}: {name}", faults) for line, row in lines]
            errors[name.removeprefix(prefix)] = tuple(values)
    refuse_lines(faults)
    refuse_rows(path, _below_zero({JOINT_ERROR.format(joint): values for joint, values in errors.items()}))
    return errors


def _epoch_faults(rows: Sequence[Epoch]) -> Iterator[Fault]:
    """Yield epochs that are not counted from 1, and numbers below zero."""
    for k, row in enumerate(rows):
        if row.epoch != k + 1:
            yield k, "epoch", row.epoch, str(k + 1)
    columns = dict[str, list[float]]()
    for name in ("validation_rmse", "rate", "gradient_norm"):
        columns[name] = [getattr(row, name) for row in rows]
    yield from _below_zero(columns)


def _below_zero(columns: Mapping[str, Sequence[float]]) -> Iterator[Fault]:
    """Yield the numbers of some columns that are below zero."""
    for name, values in columns.items():
        yield from ((k, name, value, "0 or more") for k, value in enumerate(values) if value < 0.0)
