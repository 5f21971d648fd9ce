"""From a scenario to a Recording: episodes until enough samples are kept; a fall ends one and the next begins."""

from __future__ import annotations

import logging
import time
import zlib
from collections.abc import Mapping
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from mobnet.control.commands import fixed_commands, random_commands
from mobnet.control.parameters import empty_state, walking_parameters
from mobnet.control.random_torque import make_random_torque
from mobnet.control.walking import make_walker
from mobnet.core.errors import ConfigError, SimulationError, not_accepted
from mobnet.core.provenance import provenance
from mobnet.core.recording import recording_columns, recording_width
from mobnet.core.store import write_array
from mobnet.robot.description import RobotDescription, load_robot
from mobnet.simulation.engine import make_plant, run
from mobnet.simulation.friction import make_friction
from mobnet.simulation.native import bind
from mobnet.simulation.sensing import make_sensors
from mobnet.simulation.start import start_standing, start_walking
from mobnet.simulation.world import World, leg_mask, make_world

log = logging.getLogger(__name__)
Rows = NDArray[np.float32]
STAND = "stand"  # commands of a scenario that does not walk; the other word is `random`
REPORT_WALL_S = 5.0  # between two lines of progress
FALLS_MAX = 20  # more falls than this in one recording: something is wrong with the setting


class Simulator:
    """A plant and its controller at one level, one episode after another."""

    def __init__(self, config: Mapping[str, Any], scenario: str, level: str, seed: int) -> None:
        """Build the plant; scenario and level are keys of the configuration.

        Raises:
            ConfigError: the scenario, the level or a figure of them is not accepted.
        """
        if scenario not in config["scenarios"]:
            raise ConfigError(not_accepted("scenario", scenario, config["scenarios"]))
        self.config, self.settings = config, config["scenarios"][scenario]
        robot = load_robot(Path(config["robot"]))
        self.robot: RobotDescription = robot
        self.world: World = make_world(config, robot, self.settings["terrain"], level)
        rates, row = config["rates"], config["levels"][level]
        plant = config["plant"]
        self.walker = make_walker(
            robot, walking_parameters(config["walking"]), row["nominal_mass_ratio"], plant["gravity_m_s2"]
        )
        self.sensors = make_sensors(config, level, self.world.model)
        self.torque = make_random_torque(config["random_torque"], robot.layout, self.settings["random_torque"])
        friction = make_friction(plant, leg_mask(robot), row["friction"])
        every = round(rates["plant_hz"] / rates["data_hz"])
        fall_height = config["recording"]["fall_height_m"]
        native = bind(self.world.model, self.world.data)
        self.plant = make_plant(self.world, native, friction, robot.torque_limits, fall_height, every)
        self.state = empty_state()
        streams = np.random.SeedSequence([config["seed"], zlib.crc32(scenario.encode()), seed]).spawn(4)
        self.rng_commands, self.rng_noise, self.rng_torque, self.rng_place = map(np.random.default_rng, streams)
        self.commands = np.zeros((0, 0))

    def start(self) -> None:
        """Begin an episode: fresh commands, the robot amid a step, or standing, somewhere on the terrain."""
        commands, wanted = self.config["commands"], self.settings["commands"]
        if isinstance(wanted, str):
            steps = self.config["recording"]["episode_steps"]
            self.commands = random_commands(commands, self.rng_commands, steps)
        else:
            self.commands = fixed_commands(wanted, commands["random"]["in_place_steps"])
        begin = start_standing if wanted == STAND else start_walking
        q, v = begin(self.walker, self.robot, self.state, self.commands[0], self.world.top)
        place = self.rng_place.uniform(-0.5, 0.5, 2) * self.world.period
        q[:2] += place
        self.state.old_ankle[:2] += place
        plant, data = self.plant, self.world.data
        data.qacc_warmstart[:] = 0.0
        plant.qpos[:], plant.qvel[:], plant.sensordata[:] = q, v, 0.0
        self.sensors.q[:], self.sensors.v[:] = q, v
        self.sensors.wrenches[:] = 0.0

    def run(self, rows: Rows) -> int:
        """Simulate len(rows) samples into rows (n, C); return how many came before a fall."""
        return run(
            self.plant, self.walker, self.sensors, self.state, self.torque, self.commands, self.rng_noise,
            self.rng_torque, rows,
        )  # fmt: skip


def collect(config: Mapping[str, Any], scenario: str, level: str, seed: int, duration_s: float, out_stem: Path) -> None:
    """Simulate a scenario and write the Recording `out_stem`.npy and .json (section 4.3).

    A fall ends a segment; what came in the last seconds before it is dropped and a new episode goes on until
    `duration_s` [s] are kept.

    Raises:
        ConfigError: scenario, level or duration are not accepted.
        SimulationError: the robot keeps falling.
    """
    if not duration_s > 0:
        raise ConfigError(f"duration_s: {duration_s} is not accepted; accepted: > 0")
    started = time.perf_counter()
    simulator = Simulator(config, scenario, level, seed)
    rate = config["rates"]["data_hz"]
    layout = simulator.robot.layout
    rows = np.zeros((round(duration_s * rate), recording_width(layout)), dtype=np.float32)
    segments, falls = record(simulator, rows, config["recording"], rate)
    meta = {
        "rate_hz": rate, "scenario": scenario, "level": level, "seed": seed, "falls": falls,
        "wall_s": round(time.perf_counter() - started, 1), "provenance": provenance(config),
    }  # fmt: skip
    columns = [column for group in recording_columns(layout).values() for column in group]
    write_array(out_stem, rows, columns, meta, segments)
    log.info("%s: %d samples, %d falls, %.1f x real time", out_stem.name, len(rows), falls, duration_s / meta["wall_s"])


def record(
    simulator: Simulator, rows: Rows, settings: Mapping[str, Any], rate_hz: float
) -> tuple[list[tuple[int, int]], int]:
    """Fill rows (n, C) with walked samples; return the segments kept and the number of falls.

    Raises:
        SimulationError: the robot keeps falling.
    """
    chunk, settle = round(settings["chunk_s"] * rate_hz), round(settings["settle_s"] * rate_hz)
    dropped = round(settings["dropped_before_fall_s"] * rate_hz)
    unkept = np.zeros((settle, rows.shape[1]), dtype=np.float32)
    segments: list[tuple[int, int]] = []
    falls, begin, end = 0, 0, 0
    fresh = True
    reported = time.perf_counter()
    while end < len(rows):
        if fresh:
            simulator.start()
            fresh = simulator.run(unkept) < settle
            falls += fresh
            begin = end
        else:
            span = rows[end : end + chunk]
            done = simulator.run(span)
            end += done
            if done < len(span):
                fresh, falls = True, falls + 1
                end = max(begin, end - dropped)
                segments += [(begin, end)] if end > begin else []
                log.warning("fall %d: its last %g s are dropped", falls, settings["dropped_before_fall_s"])
        if falls > FALLS_MAX:
            raise SimulationError(f"{falls} falls in {end / rate_hz:.0f} s: this setting cannot be walked")
        if time.perf_counter() - reported > REPORT_WALL_S:
            log.info("%d of %d s simulated", end / rate_hz, len(rows) / rate_hz)
            reported = time.perf_counter()
    return [*segments, (begin, end)], falls
