"""Speed of collection against real time, and against MuJoCo's step alone from the same states.

Random walking at all uncertainties, one thread, CPU time. A collection counts everything: compiling the plant,
controller, friction, noise, truth, writing the file. Not counted: starting Python and loading compiled code from the
cache (once a process). The reference calls mj_step from states of the same walk, as they stood before each step, in a
compiled loop; it repeats the walk to the bit.
"""

from __future__ import annotations

import statistics
import tempfile
import time
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numba import carray, cfunc, types
from numpy.typing import NDArray

from mobnet.control.compiled import compiled
from mobnet.core.config import load_config
from mobnet.core.recording import recording_width
from mobnet.simulation.engine import Plant
from mobnet.simulation.native import addresses_at, call_step, doubles_at
from mobnet.simulation.record import Simulator, collect

CONFIG = Path(__file__).parents[1] / "configs" / "config.yaml"
SCENARIO, LEVEL, SEED = "random_walk_plain", "all_uncertainty", 1
COLLECTED_S, REPLAYED_S, WARM_UP_S = 60.0, 10.0, 1.0  # simulated time
ROUNDS = 3
REAL_TIME_BAR, STEP_BAR = 8.0, 0.65


class Inputs(NamedTuple):
    """All that a step of the plant depends on: live arrays, and their values before each step (steps, n)."""

    live: tuple[NDArray[np.float64], ...]
    values: tuple[NDArray[np.float64], ...]


def main() -> list[dict[str, float | str]]:
    """Return two rows: times real time, and the share of a collection's CPU time that bare mj_step would take."""
    config = load_config(CONFIG)
    with tempfile.TemporaryDirectory() as folder:
        stem = Path(folder) / "recording"
        collect(config, SCENARIO, LEVEL, SEED, WARM_UP_S, stem)  # loads or compiles the loop
        simulator, inputs = _recorded_steps(config)
        _replay(simulator.plant, inputs.live, inputs.values)
        turns = [_turn(config, stem, simulator, inputs) for _ in range(ROUNDS)]
    collection, bare = (statistics.median(column) for column in zip(*turns, strict=True))
    steps = _steps(config)
    speeds = [COLLECTED_S / (ours * steps) for ours, _ in turns]
    ratios = [reference / ours for ours, reference in turns]
    return [
        {"name": "collection, all uncertainty, against real time", "ours": statistics.median(speeds), "reference": 1.0,
         "unit": "s/s", "ratio": statistics.median(speeds), "ratio_min": min(speeds), "bar": REAL_TIME_BAR},
        {"name": "collection, all uncertainty, against bare mj_step", "ours": collection * 1e6,
         "reference": bare * 1e6, "unit": "us/step", "ratio": statistics.median(ratios), "ratio_min": min(ratios),
         "bar": STEP_BAR},
    ]  # fmt: skip


def _turn(config: dict[str, Any], stem: Path, simulator: Simulator, inputs: Inputs) -> tuple[float, float]:
    """Return the CPU time [s] of a step of a collection, all it does counted, and of a bare step; in turns."""
    started = time.process_time()
    collect(config, SCENARIO, LEVEL, SEED, COLLECTED_S, stem)
    between = time.process_time()
    _replay(simulator.plant, inputs.live, inputs.values)
    ended = time.process_time()
    return (between - started) / _steps(config), (ended - between) / len(inputs.values[0])


def _steps(config: dict[str, Any]) -> float:
    """Return the steps of a collection without a fall; those before its first sample count too."""
    return (COLLECTED_S + config["recording"]["settle_s"]) * config["rates"]["plant_hz"]


def _recorded_steps(config: dict[str, Any]) -> tuple[Simulator, Inputs]:
    """Walk once with a note taken before every step; return the plant and the notes."""
    simulator = Simulator(config, SCENARIO, LEVEL, SEED)
    plant, data = simulator.plant, simulator.world.data
    steps = round(REPLAYED_S * config["rates"]["plant_hz"])
    live = (plant.qpos, plant.qvel, plant.ctrl, plant.qfrc_applied, data.qacc_warmstart)
    inputs = Inputs(live, tuple(np.zeros((steps, len(array))) for array in live))
    counter = np.zeros(1, dtype=np.int64)
    noted = _step_with_note(plant, inputs, counter)
    width = recording_width(simulator.robot.layout)
    simulator.start()
    simulator.run(np.zeros((round(config["recording"]["settle_s"] * config["rates"]["data_hz"]), width), np.float32))
    simulator.plant = plant._replace(native=plant.native._replace(step=noted.address))
    simulator.run(np.zeros((steps // plant.every, width), np.float32))
    simulator.plant = plant
    if counter[0] != steps:
        raise RuntimeError(f"{counter[0]} of {steps} steps walked: the robot fell")
    return simulator, inputs


def _step_with_note(plant: Plant, inputs: Inputs, counter: NDArray[np.int64]) -> Any:
    """Return a C function in mj_step's place that copies what the step depends on and then steps."""
    step, steps, count = plant.native.step, len(inputs.values[0]), counter.ctypes.data
    pairs = [(a.ctypes.data, b.ctypes.data, len(a)) for a, b in zip(inputs.live, inputs.values, strict=True)]
    (q, q_out, nq), (v, v_out, nv), (u, u_out, nu), (f, f_out, _), (w, w_out, _) = pairs

    @cfunc(types.void(types.int64, types.int64))
    def noted(model: int, data: int) -> None:
        k = addresses_at(count)[0]
        carray(doubles_at(q_out), (steps, nq))[k] = carray(doubles_at(q), (nq,))
        carray(doubles_at(v_out), (steps, nv))[k] = carray(doubles_at(v), (nv,))
        carray(doubles_at(u_out), (steps, nu))[k] = carray(doubles_at(u), (nu,))
        carray(doubles_at(f_out), (steps, nv))[k] = carray(doubles_at(f), (nv,))
        carray(doubles_at(w_out), (steps, nv))[k] = carray(doubles_at(w), (nv,))
        carray(addresses_at(count), (1,))[0] = k + 1
        call_step(step, model, data)

    return noted


@compiled
def _replay(plant: Plant, live: Any, values: Any) -> None:
    """Step once from each noted state."""
    for k in range(len(values[0])):
        _put(live[0], values[0], k)
        _put(live[1], values[1], k)
        _put(live[2], values[2], k)
        _put(live[3], values[3], k)
        _put(live[4], values[4], k)
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
