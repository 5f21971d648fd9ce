"""Fixed obstacles in the robot's way (sections 5.4 and 7): padded, met by every link, with a sensor of their force.

An obstacle touches nothing but the robot, whose links touch nothing else.
"""

from collections.abc import Iterator, Mapping

import mujoco
import numpy as np

from mobnet.core.arrays import Array
from mobnet.robot.description import SIDES, RobotDescription
from mobnet.robot.plant import GEOM, SLIDING, sole_name
from mobnet.settings.data import Obstacle, ObstaclePart
from mobnet.simulation.terrain import frustum

OBSTACLE_GROUP = 0  # geom group, that of the ground
PAD_RGBA = (0.80, 0.35, 0.25, 1.0)
QUATERNIONS = {"x": [0.5**0.5, 0.0, 0.5**0.5, 0.0], "y": [0.5**0.5, 0.5**0.5, 0.0, 0.0], "z": [1.0, 0.0, 0.0, 0.0]}
PREFIX = "obstacle_"  # of the names of obstacles and of their solids
IMPEDANCE = 0.01  # d of every contact: so small that a contact is a spring and a damper without a mass of its own
# Of the speed of sliding, friction may take away at most this share in a step: where it took away twice the speed, its
# sign would change at each step.
SLIDING_SHARE = 0.5


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
                pos=part.pos,
                rgba=PAD_RGBA,
                group=OBSTACLE_GROUP,
                contype=0,
                conaffinity=0,
                mass=0,
            )
            _shape(spec, geom, part)
            for link in _links(robot):
                pair = spec.add_pair(geomname1=geom.name, geomname2=link, condim=SLIDING)
                pair.friction[:2] = obstacle.friction


def _shape(spec: mujoco.MjSpec, geom: mujoco.MjsGeom, part: ObstaclePart) -> None:
    """Give a solid its shape; a tilted sole jams at a vertical side, so that what is stepped on is a frustum."""
    if part.bevel_m is None:
        geom.type = GEOM[part.type]
        geom.size[: len(part.size)] = part.size
        geom.quat = QUATERNIONS[part.axis]
        return
    bottom = np.array(part.size[:2])
    height = 2.0 * part.size[2]
    corners = frustum(bottom, bottom - part.bevel_m, height)
    corners[:, 2] -= part.size[2]  # about its middle, as a box
    spec.add_mesh(name=geom.name, uservert=corners.ravel())
    geom.type = mujoco.mjtGeom.mjGEOM_MESH
    geom.meshname = geom.name


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
        pad = next((pads[name] for name in (model.body(body).name for body in bodies) if name in pads), None)
        if pad is None:
            continue  # a sole on the ground
        corner = (1.0 - IMPEDANCE) * sum(float(model.body_invweight0[body, 0]) for body in bodies)
        stiffness = pad.stiffness_n_m * corner
        damping = pad.damping_ns_m * corner
        sliding = sliding_damping(damping, model.opt.timestep)
        model.pair_solref[k] = [-stiffness, -damping]
        model.pair_solreffriction[k] = [-stiffness, -sliding]
        model.pair_solimp[k, :2] = IMPEDANCE


def sliding_damping(damping: float, step_s: float) -> float:
    """Return the damping of MuJoCo's solref [1/s] for friction along a contact, which has another one across.

    MuJoCo takes (damping / impedance) x step of the speed in a step where friction is as stiff as `contact_grip` makes
    it.
    """
    return min(damping, SLIDING_SHARE * IMPEDANCE / step_s)


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
