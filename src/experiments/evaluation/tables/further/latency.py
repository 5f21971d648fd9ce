"""Whether the networks of a method keep up with the robot: how often they take less than a tick.

Times differ from run to run, so the table has no time: in each of some stretches of ticks the median tick is below the
robot's or it is not.
"""

# pandas has no complete types, which the strict rules of this folder ask for.
# pyright: standard

import time
from collections.abc import Mapping
from pathlib import Path

import numpy as np
import pandas as pd

from experiments.evaluation.number.laws import measured
from experiments.evaluation.number.number import Number
from experiments.evaluation.tables.look import ShownColumn, TableLook, write_look
from experiments.intervals.crossed import RunGrid
from experiments.intervals.single import share
from experiments.settings.runs import Statistics
from experiments.settings.table_columns import LATENCY
from experiments.settings.tables import Latency
from mobnet.core.columns import COMMAND, FEET
from mobnet.core.joints import NQ_BASE, JointLayout
from mobnet.core.recording import Sensed
from mobnet.learning.deployed.limbs import LimbNetworks
from mobnet.learning.deployed.loading import load_limb_networks
from mobnet.settings.plant import Rates

MET = "stretches within a tick"
MS = 1e3
LABELS = {"limbs": "Networks", "tick_ms": "Tick [ms]", "stretches": "Stretches", "ticks": "Ticks of each"}


def latency(
    settings: Latency,
    statistics: Statistics,
    rates: Rates,
    layout: JointLayout,
    seed: int,
    networks: Mapping[str, Path],
    table_dir: Path,
) -> None:
    """Write latency.csv, .tex and .md: the share of stretches of ticks whose median is within a tick [-].

    A tick is the time between two samples.

    `networks` has the folder of each limb's network.
    """
    tick_ms = MS / rates.data_hz
    medians = medians_ms(load_limb_networks(networks, layout), random_sample(layout, seed), settings)
    stretches = pd.DataFrame({"is_met": [median < tick_ms for median in medians]})
    stretches = stretches.assign(
        limbs=len(networks), tick_ms=tick_ms, stretches=settings.stretches, ticks=settings.ticks
    )

    def met(rows: pd.DataFrame) -> Number:
        return share([RunGrid(rows[["is_met"]].to_numpy(dtype=np.float64).T)], statistics)

    rows = measured(stretches, list(LABELS), {MET: met})
    shown = [ShownColumn("Within a tick", ends=f"{statistics.confidence:.0%}")]
    write_look(table_dir / "latency", rows, LATENCY, TableLook(LABELS, shown, left=0))


def random_sample(layout: JointLayout, seed: int) -> Sensed:
    """Return what sensors give at one tick of no particular motion (1-D arrays), the base upright."""
    rng = np.random.default_rng(seed)
    q = rng.normal(0.0, 0.3, layout.nq)
    q[3:NQ_BASE] = np.eye(1, NQ_BASE - 3)
    torque = rng.normal(0.0, 30.0, layout.nu)
    base = rng.normal(size=3)
    flags = np.zeros(len(FEET))
    return Sensed(q, rng.normal(size=layout.nv), base, torque, torque, flags, np.zeros(len(COMMAND)), flags)


def medians_ms(networks: LimbNetworks, sample: Sensed, settings: Latency) -> list[float]:
    """Return the median time of a tick in each stretch [ms], after one stretch that is not counted."""
    state = networks.init()
    medians = list[float]()
    for _ in range(settings.stretches + 1):
        times = []
        for _ in range(settings.ticks):
            started = time.perf_counter()
            state, _ = networks.step(state, sample)
            times.append(time.perf_counter() - started)
        medians.append(MS * float(np.median(times)))
    return medians[1:]
