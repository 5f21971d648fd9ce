"""Falls of a robot with random torques of several sizes (section 4.3)."""

import logging
from collections.abc import Sequence
from dataclasses import astuple
from pathlib import Path

from experiments.evaluation.number.files import write_csv
from mobnet.core.columns import FALLS, Falls
from mobnet.core.errors import SimulationError
from mobnet.settings.walk import WalkSettings
from mobnet.simulation.record import FALLS_MAX, record
from mobnet.simulation.simulator import Simulator

log = logging.getLogger(__name__)


def count_falls(settings: WalkSettings, seed: int, amplitudes_nm: Sequence[float], walked_s: float, out: Path) -> None:
    """Write the CSV file `out`: falls of the same walk, of `walked_s` [s], with each largest random torque [N m]."""
    rows: list[Falls] = []
    for amplitude in amplitudes_nm:
        rows.append(Falls(settings.level_name, amplitude, walked_s, falls_with(settings, seed, amplitude, walked_s)))
        log.info("%g N m: %d falls in %g s", amplitude, rows[-1].falls, walked_s)
    write_csv(out, FALLS, [astuple(row) for row in rows])


def falls_with(settings: WalkSettings, seed: int, amplitude_nm: float, walked_s: float) -> int:
    """Return the falls in `walked_s` [s] with a largest random torque on legs and waist [N m]; nothing is recorded.

    A robot that cannot walk so ends with FALLS_MAX + 1.
    """
    torque = settings.random_torque.model_copy(update={"legs_waist_nm": amplitude_nm})
    changed = settings.model_copy(update={"random_torque": torque})
    rate_hz = settings.rates.data_hz
    simulator = Simulator(changed, seed)
    samples = round(walked_s * rate_hz)
    try:
        return record(simulator, samples, settings.recording, rate_hz, lambda _: None).falls
    except SimulationError:
        return FALLS_MAX + 1
