"""What trainings take on a GPU: rates that were measured there, and the two numbers that fit them."""

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from experiments.plan.work import OnGpu
from mobnet.core.notes import Count, Note, Positive, Text

GPU_RATES = Path("docs/results/gpu.json")


class GpuNote(Note):
    """Rates of trainings on a GPU [time steps/s of all networks together].

    `alone` is that of one `nn.GRU`, `side_by_side` those of so many networks that learn as one batch, and `trained`
    that of so many on recordings, with streams, clipped gradients and a falling rate; nothing is fitted to the last.
    """

    device: Text
    date: Text
    torch: Text
    made_by: Text
    batch: Count
    horizon: Count
    units: Count
    alone: Positive
    side_by_side: dict[str, Positive]
    trained: dict[str, Positive]


@dataclass(frozen=True)
class GpuRates:
    """What an update takes: a time for its steps, which follow each other, and one for each network.

    Attributes:
        note: what was measured.
        start_s: time of an update without networks [s].
        network_s: what each network adds [s].
    """

    note: GpuNote
    start_s: float
    network_s: float

    def update_s(self, networks: int, units: int, batch: int, horizon: int) -> float:
        """Return the time of an update of networks side by side [s]: what it moves grows with units and batch."""
        size = units / self.note.units * batch / self.note.batch
        return horizon / self.note.horizon * (self.start_s + self.network_s * networks * size)

    def seconds(self, work: OnGpu) -> float:
        """Return the time of a training [s]; without a measured rate, it is that of one `nn.GRU` after another."""
        if not work.networks:
            return work.all_steps / self.note.alone
        updates = work.steps / (work.batch * work.horizon)
        return updates * self.update_s(work.networks, work.units, work.batch, work.horizon)


def fitted(note: GpuNote) -> GpuRates:
    """Return the two numbers that fit what was measured of networks side by side, by the least relative errors."""
    networks = np.array([float(count) for count in note.side_by_side])
    speeds = np.array(list(note.side_by_side.values()))
    measured_s = networks * note.batch * note.horizon / speeds
    columns = np.stack([1.0 / measured_s, networks / measured_s], axis=1)
    costs = np.linalg.lstsq(columns, np.ones(len(networks)), rcond=None)[0]
    return GpuRates(note, float(costs[0]), float(costs[1]))
