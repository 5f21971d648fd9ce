"""Robot on terrain: the compiled plant at one uncertainty level (section 5.1)."""

import math
from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType

import mujoco
import numpy as np
from numpy.typing import NDArray

from mobnet.robot.description import SIDES, RobotDescription
from mobnet.robot.plant import SLIDING, robot_spec, sole_name
from mobnet.settings.data import Obstacle
from mobnet.settings.plant import Plant
from mobnet.settings.surrogate import Level
from mobnet.simulation.obstacles import IMPEDANCE, add_obstacles, set_obstacles, sliding_damping
from mobnet.simulation.terrain import TERRAIN_GROUP, DrawnTerrain, add_terrain, top_of

DOWN = np.array([0.0, 0.0, -1.0])
SOLE_CORNERS = 4  # contacts of a sole that stands flat
RAY_M = 1.0  # rays begin this high over the highest point


@dataclass(frozen=True)
class World:
    """A plant ready to step."""

    model: mujoco.MjModel  # MuJoCo's model
    data: mujoco.MjData  # its state
    terrain: DrawnTerrain  # what was drawn
    obstacles: Mapping[str, Obstacle]  # what stands in the way

    @property
    def edge(self) -> float:
        """Distance from the origin in x or y beyond which a robot without obstacles is put back by a period [m]."""
        return math.inf if self.obstacles else self.terrain.edge

    @property
    def period(self) -> float:
        """Length after which the terrain repeats in x and y [m]."""
        return self.terrain.period


def make_world(
    robot: RobotDescription,
    terrain: DrawnTerrain,
    plant: Plant,
    level: Level,
    rate_hz: float,
    obstacles: Mapping[str, Obstacle] = MappingProxyType({}),
    rng: np.random.Generator | None = None,
) -> World:
    """Compile the robot on a terrain, stepped at a rate [1/s]; the level switches friction loss on or off.

    The distances of obstacles are drawn by `rng`.
    """
    spec = robot_spec(robot)
    add_terrain(spec, terrain)
    _add_pairs(spec)
    _set_options(spec, plant, rate_hz)
    if rng is not None:
        add_obstacles(spec, robot, obstacles, rng)
    model = spec.compile()
    _set_soles(model, plant)
    set_obstacles(model, obstacles)
    if "loss" in level.friction:
        _set_friction_loss(model, robot, plant)
    return World(model, mujoco.MjData(model), terrain, obstacles)


def ground_height(world: World, points: NDArray[np.float64]) -> NDArray[np.float64]:
    """Return the terrain's height (n,) [m] under points (n, 2) [m], found by rays from above; a robot is no ground."""
    model = world.model
    data = mujoco.MjData(model)  # the world's own may have been reset and not know where its geoms are
    mujoco.mj_kinematics(model, data)
    groups = (np.arange(mujoco.mjNGROUP) == TERRAIN_GROUP).astype(np.uint8)
    above = top_of(world.terrain) + RAY_M
    hit = np.zeros(1, dtype=np.int32)
    starts = np.column_stack([points, np.full(len(points), above)])
    return above - np.array([mujoco.mj_ray(model, data, start, DOWN, groups, 1, -1, hit) for start in starts])


def leg_mask(robot: RobotDescription) -> NDArray[np.bool_]:
    """Return which actuators (nu,) belong to a leg."""
    return np.isin(robot.layout.actuated, robot.layout.above_legs, invert=True)


def _set_options(spec: mujoco.MjSpec, plant: Plant, rate_hz: float) -> None:
    """Set integrator, solver and contact; what the truth's alignment needs (one contact force a step) is Euler's."""
    option = spec.option
    option.timestep = 1.0 / rate_hz
    option.gravity = [0.0, 0.0, -plant.gravity_m_s2]
    option.integrator = mujoco.mjtIntegrator.mjINT_EULER
    option.solver = mujoco.mjtSolver.mjSOL_NEWTON
    option.iterations = plant.solver_iterations
    option.tolerance = plant.solver_tolerance
    option.jacobian = mujoco.mjtJacobian.mjJAC_SPARSE  # dense takes a tenth longer
    option.disableflags |= int(mujoco.mjtDisableBit.mjDSBL_ISLAND)  # one robot is one island
    option.cone = mujoco.mjtCone.mjCONE_ELLIPTIC
    option.impratio = plant.contact_grip


def _add_pairs(spec: mujoco.MjSpec) -> None:
    """Name what soles may stand on, and pair it with them: only of a pair, friction has a damping of its own."""
    ground = [geom for geom in spec.worldbody.geoms if geom.group == TERRAIN_GROUP]
    for number, geom in enumerate(ground):
        geom.name = geom.name or f"terrain{number}"
        for side in SIDES:
            spec.add_pair(geomname1=geom.name, geomname2=sole_name(side), condim=SLIDING)


def _set_soles(model: mujoco.MjModel, plant: Plant) -> None:
    """Make every contact a spring and a damper, a quarter of a sole's, for a sole that stands on its four corners.

    MuJoCo's constraint force is (a_ref - a) / R with a_ref = -B v - K d r, R = (1 - d) A / d, B = b / d, K = k / d^2
    for solref (-k, -b), a constant impedance d, and A the inverse mass that it takes for the body of the sole. At rest
    that is the stiffness k / ((1 - d) A) and the damping b / ((1 - d) A); with a small d the term in a, which acts as a
    mass d / ((1 - d) A), vanishes. Friction is `contact_grip` times as stiff, so that this mass does not vanish: a
    foot then loses nearly B times the step of its speed of sliding in a step, of which B leaves the sign.
    """
    inverse_mass = float(np.mean([model.body(sole_name(side)).invweight0[0] for side in SIDES]))
    corner = (1.0 - IMPEDANCE) * inverse_mass / SOLE_CORNERS
    stiffness = plant.sole_stiffness_n_m * corner
    damping = plant.sole_damping_ns_m * corner
    model.pair_friction[:, :2] = plant.contact_friction
    model.pair_solref[:] = [-stiffness, -damping]
    model.pair_solreffriction[:] = [-stiffness, -sliding_damping(damping, model.opt.timestep)]
    model.pair_solimp[:, :2] = IMPEDANCE


def _set_friction_loss(model: mujoco.MjModel, robot: RobotDescription, plant: Plant) -> None:
    """Give the joints the friction loss of Table 4, as stiff as the step allows: a joint below it hardly creeps."""
    joints = slice(-robot.layout.nu, None)
    model.dof_frictionloss[joints] = np.where(
        leg_mask(robot), plant.friction.loss_legs_nm, plant.friction.loss_others_nm
    )
    model.dof_solref[joints] = [plant.loss_time_constant_s, 1.0]
    model.dof_solimp[joints, :2] = plant.loss_impedance
