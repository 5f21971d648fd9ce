"""Robot on terrain: the compiled plant at one uncertainty level (section 5.1)."""

from dataclasses import dataclass

import mujoco
import numpy as np
from numpy.typing import NDArray

from mobnet.robot.description import RobotDescription
from mobnet.robot.plant import robot_spec
from mobnet.settings.plant import Level, Plant
from mobnet.simulation.terrain import TERRAIN_GROUP, Terrain, add_terrain, top_of

DOWN = np.array([0.0, 0.0, -1.0])
RAY_M = 1.0  # rays begin this high over the highest point


@dataclass(frozen=True)
class World:
    """A plant ready to step."""

    model: mujoco.MjModel  # MuJoCo's model
    data: mujoco.MjData  # its state
    terrain: Terrain  # what was drawn

    @property
    def period(self) -> float:
        """Length after which the terrain repeats in x and y [m]."""
        return self.terrain.period


def make_world(robot: RobotDescription, terrain: Terrain, plant: Plant, level: Level, rate_hz: float) -> World:
    """Compile the robot on a terrain, stepped at a rate [1/s]; the level switches friction loss on or off."""
    spec = robot_spec(robot)
    add_terrain(spec, terrain)
    _set_options(spec, plant, rate_hz)
    model = spec.compile()
    if "loss" in level.friction:
        loss = np.where(leg_mask(robot), plant.friction.loss_legs_nm, plant.friction.loss_others_nm)
        model.dof_frictionloss[-robot.layout.nu :] = loss
    return World(model, mujoco.MjData(model), terrain)


def ground_height(world: World, points: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the terrain's height (n,) [m] under points (n, 2) [m], found by rays from above; a robot is no ground."""
    model = world.model
    data = mujoco.MjData(model)  # the world's own may have been reset and not know where its geoms are
    mujoco.mj_kinematics(model, data)
    groups = (np.arange(mujoco.mjNGROUP) == TERRAIN_GROUP).astype(np.uint8)
    above, hit = top_of(world.terrain) + RAY_M, np.zeros(1, dtype=np.int32)
    starts = np.column_stack([points, np.full(len(points), above)])
    return above - np.array([mujoco.mj_ray(model, data, start, DOWN, groups, 1, -1, hit) for start in starts])


def leg_mask(robot: RobotDescription) -> NDArray[np.bool_]:
    """Return which actuators (nu,) belong to a leg."""
    legs = {name for foot in robot.feet.values() for name in robot.layout.limb(foot.limb)}
    return np.array([name in legs for name in robot.layout.actuated])


def _set_options(spec: mujoco.MjSpec, plant: Plant, rate_hz: float) -> None:
    """Set integrator, solver and contact; what the truth's alignment needs (one contact force a step) is Euler's."""
    option = spec.option
    option.timestep = 1.0 / rate_hz
    option.gravity = [0.0, 0.0, -plant.gravity_m_s2]
    option.integrator = mujoco.mjtIntegrator.mjINT_EULER
    option.solver = mujoco.mjtSolver.mjSOL_NEWTON
    option.iterations = plant.solver_iterations
    option.tolerance = plant.solver_tolerance
    option.jacobian = mujoco.mjtJacobian.mjJAC_DENSE
    option.cone = mujoco.mjtCone.mjCONE_PYRAMIDAL
    for geom in spec.geoms:
        geom.friction[0] = plant.contact_friction
        geom.solref = [plant.contact_time_constant_s, plant.contact_damping_ratio]
