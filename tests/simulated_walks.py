"""Plants that walk or stand, and what they recorded."""

from dataclasses import dataclass

import numpy as np
import pytest
from library_settings import LibrarySettings, library_settings, walk_settings
from pydantic import BaseModel

from mobnet.core.columns import recording_columns, recording_width
from mobnet.simulation.simulator import Simulator
from mobnet.simulation.start import start_standing

PLACE = {"step_x_m": 0.0, "step_y_m": 0.0, "turn_deg": 0.0, "duration_s": 0.7, "foot_height_m": 0.05}
WALK = {**PLACE, "step_x_m": 0.1, "step_y_m": 0.05, "turn_deg": 8.0}
MADE_UP = {  # scenarios of the tests
    "flat_walk": {"terrain": ["flat"], "commands": WALK, "random_torque": False},
    "flat_place": {"terrain": ["flat"], "commands": PLACE, "random_torque": False},
    "checks_place": {"terrain": ["checks"], "commands": PLACE, "random_torque": False},
}


def altered(settings, **sections):
    """Return a configuration with changed sections, key by key, also where they do not fit the others."""
    changed = {name: merged(getattr(settings, name), section) for name, section in sections.items()}
    return LibrarySettings.model_validate(
        {**{name: getattr(settings, name) for name in LibrarySettings.model_fields}, **changed}
    )


def merged(value, change):
    if not isinstance(change, dict):
        return change
    own = {key: getattr(value, key) for key in value.model_fields_set} if isinstance(value, BaseModel) else value
    return {**own, **{key: merged(own.get(key, {}), new) for key, new in change.items()}}


@pytest.fixture(scope="session")
def walk_of():
    """A function (scenario, level, **sections) -> what its walk takes of the configuration, changed by the sections."""

    def make(scenario, level, **sections):
        scenarios = sections.pop("scenarios", {})
        changed = {name: {**MADE_UP.get(name, {}), **scenarios.get(name, {})} for name in {**MADE_UP, **scenarios}}
        return walk_settings(altered(library_settings(), **sections, scenarios=changed), scenario, level)

    return make


@pytest.fixture
def simulate(walk_of):
    """A function (scenario, level, seed, standing, **sections) -> a started simulator."""

    def make(scenario, level, seed=1, standing=False, **sections):
        simulator = Simulator(walk_of(scenario, level, **sections), seed)
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

    def __getitem__(self, field):
        return self.rows[:, self.columns[field]]


@pytest.fixture
def run():
    """A function (simulator, seconds) -> what it logged."""

    def advance(simulator, seconds):
        layout = simulator.robot.layout
        rows = np.zeros((round(seconds * 1000), recording_width(layout)), dtype=np.float32)
        done = simulator.run(rows)
        columns, start = {}, 0
        for name, group in recording_columns(layout).items():
            columns[name] = slice(start, start + len(group))
            start += len(group)
        return Log(rows, done, columns)

    return advance


@pytest.fixture(scope="session")
def motion(settings):
    return settings.motions["random_motion"]
