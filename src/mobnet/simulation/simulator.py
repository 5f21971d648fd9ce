"""A scenario that can be walked: plant, controller, commands, motion, random torque and pushes, episode by episode."""

from __future__ import annotations

import zlib
from collections.abc import Mapping
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from mobnet.control.commands import fixed_commands, random_commands
from mobnet.control.parameters import empty_state, walking_parameters
from mobnet.control.random_torque import make_random_torque
from mobnet.control.upper_body import UpperBody, follow
from mobnet.control.walker import make_walker
from mobnet.core.errors import ConfigError, not_accepted
from mobnet.core.recording import recording_width
from mobnet.robot.description import for_walking, load_robot
from mobnet.simulation.engine import Plant, make_plant, run
from mobnet.simulation.friction import make_friction
from mobnet.simulation.native import bind
from mobnet.simulation.pushes import Pushes, make_pushes, reset_pushes
from mobnet.simulation.sensing import Sensors, make_sensors
from mobnet.simulation.start import raise_start, start_standing, start_walking, turn
from mobnet.simulation.world import World, ground_height, leg_mask, make_world

Array = NDArray[np.float64]
Rows = NDArray[np.float32]
STAND = "stand"  # commands of an episode that does not walk
SOLE_POINTS = (5, 3)  # along and across a sole, where the ground under a start is looked for
STREAMS = ("commands", "noise", "torque", "place", "pushes", "terrain")  # of random numbers, in the order spawned


class Setting(NamedTuple):
    """A terrain, by its name, with the robot on it."""

    terrain: str
    world: World
    plant: Plant
    sensors: Sensors
    pushes: Pushes


class Simulator:
    """A plant and its controller at one level, one episode after another."""

    def __init__(
        self, config: Mapping[str, Any], scenario: str, level: str, seed: int, upper: UpperBody | None = None
    ) -> None:
        """Prepare a scenario; scenario and level are keys of the configuration.

        Args:
            config: the resolved configuration.
            scenario: what is walked.
            level: uncertainty level of section 5.1.
            seed: number of the recording; commands, noise and the rest have streams of their own.
            upper: motion of the joints above the legs; None holds the posture.

        Raises:
            ConfigError: the scenario, the level or a figure of them is not accepted.
        """
        if scenario not in config["scenarios"]:
            raise ConfigError(not_accepted("scenario", scenario, config["scenarios"]))
        self.config, self.level, self.settings = config, level, config["scenarios"][scenario]
        self.robot = for_walking(load_robot(Path(config["robot"])))
        par = walking_parameters(config["walking"])
        ratio = _level(config, level)["nominal_mass_ratio"]
        self.walker = make_walker(self.robot, par, ratio, config["plant"]["gravity_m_s2"])
        self.torque = make_random_torque(config["random_torque"], self.robot.layout, self.settings["random_torque"])
        self.upper = upper or UpperBody(par.posture_rad[None].copy(), 1.0, np.zeros(1))
        self.state = empty_state()
        draws = self.settings.get("draws", scenario)  # scenarios that differ in their pushes alone draw the same
        seeds = np.random.SeedSequence([config["seed"], zlib.crc32(draws.encode()), seed]).spawn(len(STREAMS))
        self.rng = {name: np.random.default_rng(stream) for name, stream in zip(STREAMS, seeds, strict=True)}
        self.episode = seed  # the first of the scenario's kinds of episodes depends on the seed
        self.commands: Array = np.zeros((0, 0))
        self.terrains: dict[str, Setting] = {}
        self.coming: list[str] = []  # terrains until all have been walked once more
        self.setting = self._setting(self.settings["terrain"][0])

    @property
    def world(self) -> World:
        """The terrain of the episode, with the robot on it."""
        return self.setting.world

    @property
    def plant(self) -> Plant:
        """The plant of the episode."""
        return self.setting.plant

    @property
    def sensors(self) -> Sensors:
        """The sensors of the episode."""
        return self.setting.sensors

    @property
    def width(self) -> int:
        """Number of columns of a sample."""
        return recording_width(self.robot.layout)

    def _setting(self, terrain: str) -> Setting:
        """Return a terrain with the robot on it, built once a recording."""
        if terrain not in self.terrains:
            config, level = self.config, self.config["levels"][self.level]
            world = make_world(config, self.robot, terrain, self.level, self.rng["terrain"])
            friction = make_friction(config["plant"], leg_mask(self.robot), level["friction"])
            every = round(config["rates"]["plant_hz"] / config["rates"]["data_hz"])
            limits = np.maximum(self.robot.torque_limits, config["plant"]["motor_limit_min_nm"])
            fall_height = config["recording"]["fall_height_m"]
            plant = make_plant(world, bind(world.model, world.data), friction, limits, fall_height, every)
            sensors = make_sensors(config, self.level, world.model)
            pushes = make_pushes(config["pushes"], self.settings.get("pushes", []), world.model, self.robot)
            self.terrains[terrain] = Setting(terrain, world, plant, sensors, pushes)
        return self.terrains[terrain]

    def start(self, motion_s: float = 0.0) -> None:
        """Begin an episode on one of the scenario's terrains, amid a step or standing, anywhere, facing anywhere.

        Terrains come in rounds: each once, in random order, before any comes again. The upper body
        begins where its motion is at motion_s [s] less the time to settle.
        """
        if not self.coming:
            self.coming = self.rng["place"].permutation(self.settings["terrain"]).tolist()
        self.setting = self._setting(self.coming.pop())
        wanted = self.settings["commands"]
        kind = wanted[self.episode % len(wanted)] if isinstance(wanted, list) else wanted
        self.episode += 1
        self.commands = self._commands(kind)
        clock = -self.config["recording"]["settle_s"]
        self.upper.start[0] = motion_s
        follow(self.upper, clock, self.walker.posture, self.walker.posture_rate)
        begin = start_standing if kind == STAND else start_walking
        q, v = begin(self.walker, self.robot, self.state, self.commands[0])
        yaw, place = self.rng["place"].uniform(-np.pi, np.pi), self.rng["place"].uniform(-0.5, 0.5, 2)
        turn(self.state, q, v, yaw, place * self.world.period)
        raise_start(self.state, q, ground_height(self.world, self._sole_points(yaw)).max())
        self.state.clock = clock
        reset_pushes(self.setting.pushes, clock, self.rng["pushes"])
        self._put(q, v)

    def _commands(self, kind: Any) -> Array:
        """Return the commands of an episode (n, 5)."""
        commands = self.config["commands"]
        if isinstance(kind, Mapping):
            return fixed_commands(kind, commands["random"]["in_place_steps"])
        steps = self.config["recording"]["episode_steps"]
        return random_commands({**commands, **self.settings.get("narrowed", {})}, self.rng["commands"], steps)

    def _sole_points(self, yaw: float) -> Array:
        """Return points (n, 2) [m] under both soles of a start that faces yaw [rad]."""
        robot, spacing = self.robot, self.walker.par.foot_spacing_m
        x = robot.sole.centre[0] + robot.sole.half[0] * np.linspace(-1.0, 1.0, SOLE_POINTS[0])
        y = robot.sole.half[1] * np.linspace(-1.0, 1.0, SOLE_POINTS[1])
        x, y = (grid.ravel() for grid in np.meshgrid(x, np.concatenate([y, y + spacing])))
        c, n = np.cos(yaw), np.sin(yaw)
        return self.state.old_ankle[:2] + np.column_stack([c * x - n * y, n * x + c * y])  # of the right foot

    def _put(self, q: Array, v: Array) -> None:
        """Put the plant and what its sensors read at q (nq,), v (nv,), at rest in all else."""
        plant, data = self.plant, self.world.data
        data.qacc_warmstart[:] = 0.0
        plant.xfrc_applied[:] = 0.0
        plant.qpos[:], plant.qvel[:], plant.sensordata[:] = q, v, 0.0
        self.sensors.q[:], self.sensors.v[:] = q, v
        self.sensors.wrenches[:] = 0.0

    def run(self, rows: Rows) -> int:
        """Simulate len(rows) samples into rows (n, C); return how many came before a fall."""
        rng = self.rng
        return run(
            self.plant, self.walker, self.sensors, self.state, self.commands, self.upper, self.torque,
            self.setting.pushes, rng["noise"], rng["torque"], rng["pushes"], rows,
        )  # fmt: skip


def _level(config: Mapping[str, Any], level: str) -> Mapping[str, Any]:
    """Return a level's row.

    Raises:
        ConfigError: the level is unknown.
    """
    if level not in config["levels"]:
        raise ConfigError(not_accepted("level", level, config["levels"]))
    return config["levels"][level]
