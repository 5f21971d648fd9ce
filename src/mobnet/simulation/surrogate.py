"""What a surrogate robot hides: its links, drives and sensors, drawn from its seed."""

import zlib
from typing import NamedTuple

import numpy as np

from mobnet.formats.parts import BodyRow
from mobnet.robot.description import WalkingRobot
from mobnet.robot.plant import robot_spec
from mobnet.settings.plant import Plant
from mobnet.settings.surrogate import Body, Surrogate, SurrogateRobot
from mobnet.simulation.drives import Drives, draw_drives, no_drives
from mobnet.simulation.faults import Faults, draw_faults, no_faults


class Hidden(NamedTuple):
    """A plant's robot, its numbers, drives and sensor errors."""

    robot: WalkingRobot
    plant: Plant
    drives: Drives
    faults: Faults


def draw_hidden(
    robot: WalkingRobot,
    plant: Plant,
    rate_hz: float,
    surrogate: Surrogate | None,
    chosen: SurrogateRobot | None,
    seed: int,
) -> Hidden:
    """Draw a surrogate robot, whose plant is stepped at a rate [1/s]; without one, the plant is that of section 5.1.

    Each part has random numbers of its own, so that it is the same whichever other parts are hidden.
    """
    if surrogate is None or chosen is None:
        return Hidden(robot, plant, no_drives(robot.layout.nu), no_faults(robot_spec(robot).compile()))
    seeds = np.random.SeedSequence([seed, zlib.crc32(b"surrogate"), chosen.seed]).spawn(3)
    body, drives, sensors = (np.random.default_rng(stream) for stream in seeds)
    if chosen.day:
        of_the_day = np.random.SeedSequence([seed, zlib.crc32(b"sensors of another day"), chosen.seed, chosen.day])
        sensors = np.random.default_rng(of_the_day)
    parts = chosen.parts
    if "body" in parts:
        robot = _other_links(surrogate.body, robot, chosen.payload_kg, body)
        plant = plant.model_copy(update={"sole_stiffness_n_m": body.uniform(*surrogate.body.sole_stiffness_n_m)})
    moved = no_drives(robot.layout.nu)
    rotors = robot
    robot = _without_rotors(robot) if "drives" in parts else robot
    model = robot_spec(robot).compile()
    if "drives" in parts:
        link = 1.0 / model.dof_invweight0[-robot.layout.nu :]  # inertia that a torque on each joint turns [kg m^2]
        moved = draw_drives(surrogate, rotors, link, rate_hz, drives)
        for name in ("coulomb", "viscous", "load"):
            moved.law[name] *= chosen.friction_ratio
        moved.law["constant"] *= chosen.constant_ratio
    faults = draw_faults(surrogate.sensors, robot, model, rate_hz, sensors) if "sensors" in parts else no_faults(model)
    return Hidden(robot, plant, moved, faults)


def _other_links(settings: Body, robot: WalkingRobot, load_kg: float, rng: np.random.Generator) -> WalkingRobot:
    """Return a robot whose links have other masses and centres of mass, one of them a payload and `load_kg` [kg]."""
    bodies: list[BodyRow] = []
    for row in robot.bodies:
        ratio = rng.uniform(1 - settings.mass_share, 1 + settings.mass_share)
        com = rng.uniform(-1, 1, 3)
        update = {
            "mass": ratio * row.mass,
            "inertia": tuple(ratio * value for value in row.inertia),
            "com": tuple(np.add(row.com, settings.com_m * com).tolist()),
        }
        if row.name == settings.payload_body:
            update["mass"] += rng.uniform(*settings.payload_kg) + load_kg
        bodies.append(row.model_copy(update=update))
    return WalkingRobot(**{**vars(robot), "bodies": tuple(bodies)})


def _without_rotors(robot: WalkingRobot) -> WalkingRobot:
    """Return a robot without the rotors' inertia, which its drives have."""
    joints = tuple(joint.model_copy(update={"armature": 0.0}) for joint in robot.joints)
    return WalkingRobot(**{**vars(robot), "joints": joints})
