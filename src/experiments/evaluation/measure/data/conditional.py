"""Ranges of a joint's torque under conditions: the phase of the gait, or its position and velocity.

Pooled over a whole walk, every torque has occurred somewhere; a torque at its phase, or at its place and speed, need
not have.
"""

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np
import pandas as pd
from numpy.typing import NDArray

from experiments.evaluation.compare.rmse import Spans
from mobnet.core.arrays import Array

HALF = 0.5  # phase at which a leg touches down


@dataclass(frozen=True)
class Cells:
    """Equal cells of one condition or more, numbered; what lies outside of their edges is in none.

    Attributes:
        edges: of the cells along each condition, (n_k + 1,) in its unit.
    """

    edges: tuple[Array, ...]

    @property
    def count(self) -> int:
        """Number of cells."""
        return int(np.prod([len(edge) - 1 for edge in self.edges]))

    def of(self, conditions: NDArray[Any]) -> NDArray[np.intp]:
        """Return the number of the cell (n,) of each sample's conditions (n, k), -1 where it is in none."""
        number = np.zeros(len(conditions), dtype=np.intp)
        inside = np.ones(len(conditions), dtype=bool)
        for edge, values in zip(self.edges, conditions.T, strict=True):
            place = np.searchsorted(edge, values, side="right") - 1
            place[values == edge[-1]] = len(edge) - 2
            inside &= (place >= 0) & (place < len(edge) - 1)
            number = number * (len(edge) - 1) + place
        return np.where(inside, number, -1)


@dataclass(frozen=True)
class TorqueRange:
    """The central range of a torque in each cell, (count,) [N m]; NaN in cells with too few samples.

    Attributes:
        cells: the cells.
        low: lower ends.
        high: upper ends.
    """

    cells: Cells
    low: Array
    high: Array

    def outside(self, conditions: NDArray[Any], torque: NDArray[Any]) -> NDArray[np.bool_]:
        """Return whether torques (n,) [N m] lie outside the range of their cell, or in a cell without one."""
        cell = self.cells.of(conditions)
        return (cell < 0) | ~((torque >= self.low[cell]) & (torque <= self.high[cell]))

    @property
    def width(self) -> float:
        """Mean width of the range over the cells that have one [N m]; NaN if none has."""
        width = self.high - self.low
        return float(width[np.isfinite(width)].mean()) if np.isfinite(width).any() else float("nan")


def even_cells(bounds: Sequence[tuple[float, float]], counts: Sequence[int]) -> Cells:
    """Return so many equal cells along each condition, between its bounds [its unit]."""
    return Cells(tuple(np.linspace(*ends, count + 1) for ends, count in zip(bounds, counts, strict=True)))


def torque_range(
    cells: Cells, conditions: NDArray[Any], torque: NDArray[Any], shares: Sequence[float], least: int
) -> TorqueRange:
    """Return the range of torques (n,) [N m] between two quantiles in each cell with `least` samples or more.

    The conditions are (n, k), in the units of the cells.
    """
    cell = cells.of(conditions)
    groups = pd.Series(torque[cell >= 0].astype(np.float64)).groupby(cell[cell >= 0])
    ends = groups.quantile(np.asarray(shares)).unstack()[groups.size() >= least]
    low, high = np.full((2, cells.count), np.nan)
    # Without any sample pandas gives no columns, and no cell has a range.
    low[ends.index], high[ends.index] = ends.to_numpy().reshape(-1, 2).T
    return TorqueRange(cells, low, high)


def gait_phase(air: NDArray[np.bool_], segments: Spans) -> Array:
    """Return a leg's phase of the gait (T,) [-]: 0 to 0.5 while it swings, 0.5 to 1 while it stands.

    Within each of the two it is the share of the time that has passed. It is NaN where the beginning or the end of the
    swing or stance is not in the segment (start, end).
    """
    phase = np.full(len(air), np.nan)
    for first, last in segments:
        edges = first + 1 + np.flatnonzero(np.diff(air[first:last]))
        for start, end in pairwise(edges):
            phase[start:end] = HALF * (np.arange(end - start) / (end - start) + (not air[start]))
    return phase
