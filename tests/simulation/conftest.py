"""Plants that walk or stand, and what they recorded."""

from __future__ import annotations

import copy
from collections.abc import Callable
from dataclasses import dataclass
from typing import Any

import numpy as np
import pytest

from mobnet.core.recording import recording_columns, recording_width
from mobnet.simulation.simulator import Simulator
from mobnet.simulation.start import start_standing

IN_PLACE = {"step_x_m": 0.0, "step_y_m": 0.0, "turn_deg": 0.0, "duration_s": 0.7, "foot_height_m": 0.05}
MADE_UP = {  # scenarios of the tests
    "flat_walk": {"terrain": ["flat"], "commands": {**IN_PLACE, "step_x_m": 0.1, "step_y_m": 0.05, "turn_deg": 8.0}},
    "flat_place": {"terrain": ["flat"], "commands": IN_PLACE},
    "checks_place": {"terrain": ["checks"], "commands": IN_PLACE},
}


@pytest.fixture
def config(full_config: dict[str, Any]) -> dict[str, Any]:
    """A configuration to change, with the tests' own scenarios."""
    config = copy.deepcopy(full_config)
    config["scenarios"] |= {name: {**row, "random_torque": False} for name, row in MADE_UP.items()}
    return config


@pytest.fixture
def simulate(config: dict[str, Any]) -> Callable[..., Simulator]:
    """A function (scenario, level, seed, standing) -> a started simulator."""

    def make(scenario: str, level: str, seed: int = 1, standing: bool = False) -> Simulator:
        simulator = Simulator(config, scenario, level, seed)
        simulator.start()
        if standing:
            start = start_standing(simulator.walker, simulator.robot, simulator.state, simulator.commands[0])
            simulator.plant.qpos[:], simulator.plant.qvel[:] = start
            simulator.sensors.q[:], simulator.sensors.v[:] = start
        return simulator

    return make


@dataclass(frozen=True)
class Log:
    """Samples (T, C) and how many came before a fall."""

    rows: np.ndarray
    done: int
    columns: dict[str, slice]

    def __getitem__(self, field: str) -> np.ndarray:
        """Return one field of the samples."""
        return self.rows[:, self.columns[field]]


@pytest.fixture
def run() -> Callable[[Simulator, float], Log]:
    """A function (simulator, seconds) -> what it logged."""

    def advance(simulator: Simulator, seconds: float) -> Log:
        layout = simulator.robot.layout
        rows = np.zeros((round(seconds * 1000), recording_width(layout)), dtype=np.float32)
        done = simulator.run(rows)
        columns, start = {}, 0
        for name, group in recording_columns(layout).items():
            columns[name] = slice(start, start + len(group))
            start += len(group)
        return Log(rows, done, columns)

    return advance
