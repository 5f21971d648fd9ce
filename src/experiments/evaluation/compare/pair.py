"""An estimate and the truth that it is compared with, read from the files of a run."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from experiments.evaluation.compare.rmse import Spans
from experiments.plan.runs import Run
from mobnet.core.columns import EXTERNAL, EXTERNAL_LP, STD, named
from mobnet.core.errors import ConfigError, DataError, not_accepted, refuse
from mobnet.core.joints import JointLayout
from mobnet.core.notes import note_differences, read_array_note
from mobnet.core.store import NOTE, file_of, label_of, read_array, spans_and_rate


@dataclass(frozen=True)
class Pair:
    """The estimate of a run and the truth behind the observer's low-pass: external torque (T, n) [N m], V1..V3 [N].

    Both are of the same joints (n,) and samples, and so is the label, what foot sensors say of the truth, if they do;
    spans (start, end) are contiguous rows.
    """

    run: Run
    joints: tuple[str, ...]
    estimate: NDArray[Any]
    truth: NDArray[Any]
    spans: Spans
    rate_hz: float
    label: NDArray[Any] | None = None

    def only(self, joints: Sequence[str]) -> Pair:
        """Return what it holds of some joints; of those that are not estimated it holds nothing."""
        kept = tuple(joint for joint in self.joints if joint in joints)
        columns = self.places(kept)
        label = None if self.label is None else self.label[:, columns]
        return replace(self, joints=kept, estimate=self.estimate[:, columns], truth=self.truth[:, columns], label=label)

    def places(self, joints: Sequence[str]) -> list[int]:
        """Return the columns of joints in the arrays (n,).

        Raises:
            ConfigError: one is not estimated.
        """
        for joint in joints:
            if joint not in self.joints:
                raise ConfigError(f"{self.run.estimate}.json: {not_accepted('joint', joint, self.joints)}")
        return [self.joints.index(joint) for joint in joints]


def read_pair(run: Run, layout: JointLayout) -> Pair:
    """Read an estimate and the truth of the same joints, (T, n) [N m].

    Raises:
        DataError: a file is missing or damaged, a column is missing, or rows or segments differ.
    """
    meta, residual_meta = (read_array_note(file_of(stem, NOTE)) for stem in (run.estimate, run.residual))
    refuse(f"{run.estimate}{NOTE}", note_differences(meta, residual_meta, f"{run.residual}{NOTE}"))
    names = [column["name"] for column in meta["columns"]]
    joints = tuple(joint for joint in layout.names if f"{EXTERNAL}.{joint}" in names)
    if not joints:
        raise DataError(f"{run.estimate}.json: no column {EXTERNAL}.<joint>; it holds {', '.join(names)}")
    # Networks of surrogate robots learn what foot sensors say of the truth (docs/notes/surrogate.md): errors against
    # this label are measured beside those against the truth.
    signal = label_of(run.residual)
    return Pair(
        run,
        joints,
        read_array(run.estimate, named(EXTERNAL, joints), layout)[0],
        read_array(run.residual, named(EXTERNAL_LP, joints), layout)[0],
        *spans_and_rate(meta),
        None if signal == EXTERNAL_LP else read_array(run.residual, named(signal, joints), layout)[0],
    )


def read_std(run: Run, joints: Sequence[str]) -> NDArray[np.float32] | None:
    """Return the standard deviations that a method predicts (T, n) [N m], V1..V3 [N]; None if it predicts none."""
    columns = {column["name"] for column in read_array_note(file_of(run.estimate, NOTE))["columns"]}
    names = named(STD, joints)
    return read_array(run.estimate, names)[0] if columns.issuperset(names) else None


class Measured(NamedTuple):
    """A metric of n joints; nan where it is not defined, which makes no row.

    Its unit is that of `experiments.settings.metrics`. Where only the average counts, joints get no rows of their own.
    """

    metric: str
    values: NDArray[np.float64]
    average_only: bool = False


Measures = Iterator[Measured]
