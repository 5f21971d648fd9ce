"""Fixed obstacles in the robot's way (sections 5.4 and 7): padded, met by every link, with a sensor of their force.

An obstacle touches nothing but the robot, whose links touch nothing else.
"""

from collections.abc import Iterator, Mapping

import mujoco
import numpy as np

from mobnet.core.arrays import Array
from mobnet.robot.description import SIDES, RobotDescription
from mobnet.robot.plant import GEOM, SLIDING, sole_name
from mobnet.settings.data import Obstacle

OBSTACLE_GROUP = 0  # geom group, that of the ground
PAD_RGBA = (0.80, 0.35, 0.25, 1.0)
QUATERNIONS = {"x": [0.5**0.5, 0.0, 0.5**0.5, 0.0], "y": [0.5**0.5, 0.5**0.5, 0.0, 0.0], "z": [1.0, 0.0, 0.0, 0.0]}
PREFIX = "obstacle_"  # of the names of obstacles and of their solids
IMPEDANCE = 0.01  # d of every contact: so small that a contact is a spring and a damper without a mass of its own


def add_obstacles(
    spec: mujoco.MjSpec, robot: RobotDescription, obstacles: Mapping[str, Obstacle], rng: np.random.Generator
) -> None:
    """Add obstacles by name at distances that are drawn, ahead of the origin along x, and what touches them."""
    for name, obstacle in obstacles.items():
        place = [rng.uniform(*obstacle.ahead_m), 0.0, 0.0]
        body = spec.worldbody.add_body(name=f"{PREFIX}{name}", pos=place, explicitinertial=True)
        body.add_site(name=f"{PREFIX}{name}")
        spec.add_sensor(
            name=f"{PREFIX}{name}",
            type=mujoco.mjtSensor.mjSENS_FORCE,
            objtype=mujoco.mjtObj.mjOBJ_SITE,
            objname=f"{PREFIX}{name}",
        )
        for number, part in enumerate(obstacle.parts):
            geom = body.add_geom(
                name=f"{PREFIX}{name}_{number}",
                type=GEOM[part.type],
                pos=part.pos,
                rgba=PAD_RGBA,
                group=OBSTACLE_GROUP,
                contype=0,
                conaffinity=0,
                mass=0,
            )
            geom.size[: len(part.size)] = part.size
            geom.quat = QUATERNIONS[part.axis]
            for link in _links(robot):
                pair = spec.add_pair(geomname1=geom.name, geomname2=link, condim=SLIDING)
                pair.friction[:2] = obstacle.friction


def _links(robot: RobotDescription) -> Iterator[str]:
    """Yield the names of the solids that meet an obstacle: soles, below the feet's sensors, and all other shapes."""
    yield from (sole_name(side) for side in SIDES)
    for shape in robot.shapes:
        if shape.name not in [f"{side}_foot" for side in SIDES]:  # what is seen of a sole
            yield shape.name


def set_obstacles(model: mujoco.MjModel, obstacles: Mapping[str, Obstacle]) -> None:
    """Make each contact with an obstacle a spring and a damper, as `world` does those of the soles."""
    pads = {f"{PREFIX}{name}": obstacle for name, obstacle in obstacles.items()}
    for k in range(model.npair):
        geoms = model.pair_geom1[k], model.pair_geom2[k]
        bodies = [int(model.geom_bodyid[geom]) for geom in geoms]
        names = [model.body(body).name for body in bodies]
        pad = next(pads[name] for name in names if name in pads)
        corner = (1.0 - IMPEDANCE) * sum(float(model.body_invweight0[body, 0]) for body in bodies)
        model.pair_solref[k] = [-pad.stiffness_n_m * corner, -pad.damping_ns_m * corner]
        model.pair_solimp[k, :2] = IMPEDANCE


def points_on(model: mujoco.MjModel, data: mujoco.MjData) -> Array:
    """Return the points at which obstacles touch the robot in the last step (n, 3) [m], world axes."""
    touched = list[bool]()
    for pair in data.contact.geom:
        touched.append(any(model.geom(geom).name.startswith(PREFIX) for geom in pair))
    return data.contact.pos[touched]


def place_of(model: mujoco.MjModel, name: str) -> Array:
    """Return the place of an obstacle (3,) [m]."""
    return np.array(model.body(f"{PREFIX}{name}").pos)


def obstacle_force(model: mujoco.MjModel, data: mujoco.MjData, name: str) -> Array:
    """Return the force of an obstacle on the robot in the last step (3,) [N], world axes."""
    start = model.sensor(f"{PREFIX}{name}").adr[0]
    return np.array(data.sensordata[start : start + 3])
