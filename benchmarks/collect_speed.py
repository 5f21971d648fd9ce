"""Speed of collection against real time, and against MuJoCo's step alone from the same states.

The full setting, random walking with random torque and pushes at all uncertainties, once on each of its terrains; one
thread, CPU time. A collection counts everything: compiling the plants, controller, friction, noise, truth, writing the
file. Not counted: starting Python and loading compiled code from the cache (once a process). The reference calls
mj_step in a compiled loop along stretches of the very same walks, from the states as they stood before each step; it
repeats them to the bit. A fall counts against us: what is walked anew after it is not in the steps.
"""

import statistics
import tempfile
import time
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from experiments.plan.jobs import walk_settings
from experiments.plan.seeds import FIRST_TRAINING_SEED
from experiments.settings.load import load_settings
from mobnet.core.compilation import compiled
from mobnet.settings.walking import WalkSettings
from mobnet.simulation.engine import LivePlant
from mobnet.simulation.native import call_step
from mobnet.simulation.record import collect
from mobnet.simulation.simulator import Simulator

SCENARIO, LEVEL, SEED = "random_walk", "all_uncertainty", FIRST_TRAINING_SEED
COLLECTED_S, WARM_UP_S = 75.0, 1.0  # simulated time
UNNOTED_S, NOTED_S = 7.0, 0.5  # simulated in turns
ROUNDS = 3
REAL_TIME_BAR, STEP_BAR = 12.0, 0.75


class Inputs(NamedTuple):
    """All that a step of a plant depends on: live arrays (n,), and their values before noted steps (steps, n)."""

    live: tuple[NDArray[np.float64], ...]
    values: tuple[NDArray[np.float64], ...]


def main() -> list[dict[str, float | str]]:
    """Return two rows: times real time, and the share of a collection's CPU time that bare mj_step would take."""
    full = walk_settings(load_settings(), SCENARIO, LEVEL)
    walks = [_on(full, terrain) for terrain in full.scenario.terrain]
    with tempfile.TemporaryDirectory() as folder:
        stem = Path(folder) / "recording"
        collect(full, SEED, WARM_UP_S, stem)  # loads or compiles the loop
        noted = [_noted_steps(walk) for walk in walks]
        turns = [_turn(walks, noted, stem) for _ in range(ROUNDS)]
    collection, bare = (statistics.median(column) for column in zip(*turns, strict=True))
    speeds = [COLLECTED_S / (ours * _steps(full)) for ours, _ in turns]
    ratios = [reference / ours for ours, reference in turns]
    return [
        {"name": "collection, full setting, against real time", "ours": statistics.median(speeds), "reference": 1.0,
         "unit": "s/s", "ratio": statistics.median(speeds), "ratio_min": min(speeds), "bar": REAL_TIME_BAR},
        {"name": "collection, full setting, against bare mj_step", "ours": collection * 1e6,
         "reference": bare * 1e6, "unit": "us/step", "ratio": statistics.median(ratios), "ratio_min": min(ratios),
         "bar": STEP_BAR},
    ]  # fmt: skip


def _on(settings: WalkSettings, terrain: str) -> WalkSettings:
    """Return the settings of a walk on one terrain alone."""
    return settings.model_copy(update={"scenario": settings.scenario.model_copy(update={"terrain": (terrain,)})})


def _turn(walks: list[WalkSettings], noted: list[tuple[Simulator, Inputs]], stem: Path) -> tuple[float, float]:
    """Return the CPU time [s] of a step of the collections, all they do counted, and of a bare step; in turns."""
    ours = bare = steps = 0.0
    for walk, (simulator, inputs) in zip(walks, noted, strict=True):
        started = time.process_time()
        collect(walk, SEED, COLLECTED_S, stem)
        between = time.process_time()
        _replay(simulator.plant, *inputs)
        ended = time.process_time()
        ours, bare, steps = ours + between - started, bare + ended - between, steps + len(inputs.values[0])
    return ours / (len(walks) * _steps(walks[0])), bare / steps


def _steps(settings: WalkSettings) -> float:
    """Return the steps of a collection without a fall; those before its first sample count too."""
    return (COLLECTED_S + settings.recording.settle_s) * settings.rates.plant_hz


def _noted_steps(settings: WalkSettings) -> tuple[Simulator, Inputs]:
    """Walk what is collected, with notes in stretches spread evenly over it; return the plant and the notes."""
    simulator = Simulator(settings, SEED)
    simulator.start()
    plant, data = simulator.plant, simulator.world.data
    before = (plant.qpos, plant.qvel, data.qacc_warmstart)  # what a step changes; the loop sets the others
    live = (*before, plant.ctrl, plant.qfrc_applied, plant.xfrc_applied.ravel())
    values: list[list[NDArray[np.float64]]] = [[] for _ in live]
    end = plant.qpos.copy()
    unnoted = np.zeros((round(UNNOTED_S * settings.rates.data_hz), simulator.width), np.float32)
    for _ in range(round(COLLECTED_S / (UNNOTED_S + NOTED_S))):
        simulator.plant = plant
        if simulator.run(unnoted) < len(unnoted):
            break  # a fall
        simulator.plant = plant._replace(every=1)
        for _ in range(round(NOTED_S * settings.rates.plant_hz)):
            states = [array.copy() for array in before]
            simulator.run(unnoted[:1])
            end = plant.qpos.copy()
            for column, array in zip(values, [*states, *live[len(before) :]], strict=True):
                column.append(array.copy())
    inputs = Inputs(live, tuple(map(np.array, values)))
    _replay(plant, *inputs)
    np.testing.assert_array_equal(plant.qpos, end)  # the replay repeats the walk to the bit
    return simulator, inputs


@compiled
def _replay(plant: LivePlant, live: Any, values: Any) -> None:
    """Step once from each noted state."""
    for k in range(len(values[0])):
        _put(live[0], values[0], k)
        _put(live[1], values[1], k)
        _put(live[2], values[2], k)
        _put(live[3], values[3], k)
        _put(live[4], values[4], k)
        _put(live[5], values[5], k)
        call_step(plant.native.step, plant.native.model, plant.native.data)


@compiled
def _put(live: NDArray[np.float64], values: NDArray[np.float64], k: int) -> None:
    """Copy row k of values (steps, n) into live (n,)."""
    for i in range(len(live)):
        live[i] = values[k, i]


if __name__ == "__main__":
    for row in main():
        print(
            "{name}: {ours:.2f} against {reference:.2f} {unit}, ratio {ratio:.2f}, least {ratio_min:.2f}".format(**row)
        )
