"""A scenario that can be walked: plant, controller, commands, motion, random torque and pushes, episode by episode."""

import zlib
from operator import is_
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from mobnet.control.commands import fixed_commands, joystick_law, random_commands, uniform_law
from mobnet.control.parameters import empty_state
from mobnet.control.random_torque import make_exploration
from mobnet.control.upper_body import UpperBody, follow
from mobnet.control.walker import make_walker
from mobnet.core.arrays import Array
from mobnet.core.columns import recording_width
from mobnet.core.machine_code import HeldValue, hold
from mobnet.robot.description import describe, for_walking
from mobnet.settings.data import CommandSource, FixedCommand
from mobnet.settings.walking import WalkSettings
from mobnet.simulation.drives import reset_drives
from mobnet.simulation.engine import LivePlant, Loop, make_plant, run
from mobnet.simulation.faults import reset_faults
from mobnet.simulation.friction import make_friction
from mobnet.simulation.native import bind
from mobnet.simulation.pushes import Pushes, make_pushes, reset_pushes
from mobnet.simulation.sensing import Sensors, make_sensors, reset_sensors
from mobnet.simulation.start import raise_start, start_standing, start_walking, turn
from mobnet.simulation.surrogate import draw_hidden
from mobnet.simulation.terrain import draw_terrain
from mobnet.simulation.world import World, ground_height, leg_mask, make_world

Rows = NDArray[np.float32]
STAND = "stand"  # commands of an episode that does not walk
LAWS = {"joystick": joystick_law, "uniform": uniform_law}  # commands that are drawn, but not by `commands.random`
SOLE_POINTS = (5, 3)  # along and across a sole, where the ground under a start is looked for
# Streams of random numbers, in the order spawned.
STREAMS = ("commands", "noise", "torque", "place", "pushes", "terrain", "running", "obstacles")


class Setting(NamedTuple):
    """A terrain, by its name, with the robot on it."""

    terrain: str
    world: World
    plant: LivePlant
    sensors: Sensors
    pushes: Pushes


class Simulator:
    """A plant and its controller at one level, one episode after another."""

    def __init__(self, settings: WalkSettings, seed: int, upper: UpperBody | None = None) -> None:
        """Prepare the scenario of a recording; without a motion the joints above the legs hold their posture.

        Raises:
            ConfigError: the robot cannot walk, or plates find no room.
        """
        self.settings = settings
        scenario = settings.scenario
        self.robot = for_walking(describe(settings.robot))
        ratio = settings.level.nominal_mass_ratio
        gravity = settings.plant.gravity_m_s2
        self.walker = make_walker(self.robot, settings.walking, ratio, gravity)
        self.torque = make_exploration(settings.random_torque, self.robot.layout, bool(scenario.random_torque))
        self.upper = upper or UpperBody(self.robot.posture.angle[None].copy(), 1.0, np.zeros(1))
        self.state = empty_state()
        draws = scenario.draws or settings.scenario_name  # scenarios that differ in their pushes alone draw the same
        seeds = np.random.SeedSequence([settings.seed, zlib.crc32(draws.encode()), seed]).spawn(len(STREAMS))
        self.rng = {name: np.random.default_rng(stream) for name, stream in zip(STREAMS, seeds, strict=True)}
        chosen = settings.level.surrogate
        rate = settings.rates.plant_hz
        self.hidden = draw_hidden(self.robot, settings.plant, rate, settings.surrogate, chosen, settings.seed)
        self.running_s = self.rng["running"].uniform(*chosen.running_s) if chosen else 0.0
        self.episode = seed  # the first of the scenario's kinds of episodes depends on the seed
        self.commands: Array = np.zeros((0, 0))
        self._held: HeldValue | None = None
        # terrains until all have been walked once more; seeds that follow each other begin on each in turn, so that
        # walks of one episode come to all of them equally often
        self.coming = [scenario.terrain[seed % len(scenario.terrain)]]
        self._enter(scenario.terrain[0])

    @property
    def width(self) -> int:
        """Number of columns of a sample."""
        return recording_width(self.robot.layout)

    def _enter(self, terrain: str) -> None:
        """Put the robot on a terrain that is drawn anew."""
        settings = self.settings
        rates = self.settings.rates
        robot, plant, drives, faults = self.hidden
        drawn = draw_terrain(dict(settings.terrain)[terrain], self.rng["terrain"])
        world = make_world(
            robot, drawn, plant, settings.level, rates.plant_hz, settings.obstacles, self.rng["obstacles"]
        )
        friction = make_friction(plant, leg_mask(self.robot), settings.level.friction)
        every = round(rates.plant_hz / rates.data_hz)
        limits = np.maximum(self.robot.torque_limits, plant.motor_limit_min_nm)
        native = bind(world.model, world.data)
        fall_height = settings.recording.fall_height_m
        chosen = settings.level.surrogate
        errors = None
        if settings.surrogate is not None and chosen is not None and "sensors" in chosen.parts:
            errors = settings.surrogate.sensors
        estimated = settings.scenario.wrench == "estimated"
        sensors = make_sensors(plant, settings.level, world.model, estimated, errors)
        pushes = make_pushes(settings.pushes, world.model, self.robot)
        plant = make_plant(world, native, friction, drives, faults, limits, fall_height, every)
        self.setting = Setting(terrain, world, plant, sensors, pushes)
        _, self.world, self.plant, self.sensors, self.pushes = self.setting

    def start(self, motion_s: float = 0.0) -> None:
        """Begin an episode on one of the scenario's terrains, amid a step or standing, anywhere, facing anywhere.

        After that of the first episode, terrains come in rounds: each once, in random order, before any comes again.
        The upper body begins where its motion is at motion_s [s] less the time to settle.
        """
        if not self.coming:
            self.coming = self.rng["place"].permutation(self.settings.scenario.terrain).tolist()
        self._enter(self.coming.pop())
        wanted = self.settings.scenario.commands
        kind = wanted[self.episode % len(wanted)] if isinstance(wanted, tuple) else wanted
        self.episode += 1
        self.commands = self._commands(kind)
        clock = -self.settings.recording.settle_s
        self.upper.start[0] = motion_s
        follow(self.upper, clock, self.walker.posture, self.walker.posture_rate)
        begin = start_standing if kind == STAND else start_walking
        q, v = begin(self.walker, self.robot, self.state, self.commands[0])
        yaw = self.rng["place"].uniform(-np.pi, np.pi)
        place = self.rng["place"].uniform(-0.5, 0.5, 2)
        if self.settings.obstacles:
            yaw = 0.0
            place = np.zeros(2)
        turn(self.state, q, v, yaw, place * self.world.period)
        raise_start(self.state, q, ground_height(self.world, self._sole_points(yaw)).max())
        self.state.clock = clock
        reset_pushes(self.pushes, clock, self.rng["pushes"])
        self._put(q, v)
        reset_drives(self.hidden.drives, q[7:], v[6:], self.running_s + motion_s)

    def _commands(self, kind: CommandSource | FixedCommand) -> Array:
        """Return the commands of an episode (n, 5)."""
        commands = self.settings.commands
        narrowed = self.settings.scenario.narrowed
        if isinstance(kind, FixedCommand):
            return fixed_commands(kind, commands.random.in_place_steps)
        ranges = commands.model_copy(update={name: value for name, value in narrowed if value is not None})
        law = LAWS[kind](ranges) if kind in LAWS else ranges
        return random_commands(law, self.rng["commands"], self.settings.recording.episode_steps)

    def _sole_points(self, yaw: float) -> Array:
        """Return points (n, 2) [m] under both soles of a start that faces yaw [rad]."""
        robot = self.robot
        spacing = self.walker.par.foot_spacing_m
        x = robot.sole.box_centre[0] + robot.sole.box_half[0] * np.linspace(-1.0, 1.0, SOLE_POINTS[0])
        y = robot.sole.box_half[1] * np.linspace(-1.0, 1.0, SOLE_POINTS[1])
        x, y = (grid.ravel() for grid in np.meshgrid(x, np.concatenate([y, y + spacing])))
        c = np.cos(yaw)
        n = np.sin(yaw)
        return self.state.old_ankle[:2] + np.column_stack([c * x - n * y, n * x + c * y])  # of the right foot

    def _put(self, q: Array, v: Array) -> None:
        """Put the plant and what its sensors read at q (nq,), v (nv,), at rest in all else."""
        plant = self.plant
        data = self.world.data
        data.qacc_warmstart[:] = 0.0
        plant.xfrc_applied[:] = 0.0
        plant.qpos[:] = q
        plant.qvel[:] = v
        plant.sensordata[:] = 0.0
        reset_sensors(self.sensors, q, v, self.rng["noise"])
        reset_faults(self.hidden.faults, self.sensors)

    def run(self, rows: Rows) -> int:
        """Simulate len(rows) samples into rows (n, C); return how many came before a fall."""
        rng = self.rng
        parts = self.plant, self.walker, self.sensors, self.state, self.upper, self.torque, self.pushes
        loop = Loop(*parts, rng["noise"], rng["torque"], rng["pushes"])
        if self._held is None or not all(map(is_, loop, self._held.of)):  # another episode, or other parts
            self._held = hold(loop)
        return run(self._held, self.commands, rows)
