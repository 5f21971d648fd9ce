"""The plant's robot for MuJoCo, the simulated truth. Terrain, contact figures and options are the world's."""

from collections.abc import Mapping

import mujoco

from mobnet.formats.parts import BodyRow, Colour, ImuRow, ShapeRow, SoleRow
from mobnet.formats.robot import WORLD
from mobnet.robot.description import RobotDescription

SOLE_TYPE = 2  # contype of soles and conaffinity of terrain: only soles on terrain collide
TERRAIN_TYPE = 1  # contype of terrain and conaffinity of soles
SLIDING = 3  # condim: a normal and two tangential directions
SHAPE_GROUP = 2  # geom group of what is looked at
SOLE_GROUP = 3  # geom group of collision boxes, hidden by default
GEOM = {
    name: getattr(mujoco.mjtGeom, f"mjGEOM_{name.upper()}")
    for name in ("capsule", "cylinder", "box", "ellipsoid", "sphere")
}
FOOT_SENSORS = {
    "force": mujoco.mjtSensor.mjSENS_FORCE,
    "torque": mujoco.mjtSensor.mjSENS_TORQUE,
    "acc": mujoco.mjtSensor.mjSENS_ACCELEROMETER,
}
IMU_SENSORS = {"gyro": mujoco.mjtSensor.mjSENS_GYRO, "acc": mujoco.mjtSensor.mjSENS_ACCELEROMETER}


def robot_spec(robot: RobotDescription) -> mujoco.MjSpec:
    """Return the robot as a MuJoCo specification, without terrain, motor limits, damping and friction.

    `qvel` is then the generalized velocity of `JointLayout`: base linear [m/s] in world axes, base angular [rad/s] in
    base axes, joints [rad/s] in the order of `layout.actuated`; with a fixed base, the joints alone. Motors and joints
    are named by their ids and stand in that order; motors pass ctrl [N m] on unclipped. Sensors, where the robot has
    them: `imu_gyro`, `imu_acc`, `left_foot_force`, `left_foot_torque`, `left_foot_acc` and the same of the right foot;
    force and torque of a foot are minus the ground's wrench at the sensor, acc is the specific force there.
    """
    spec = mujoco.MjSpec()
    spec.modelname = robot.name
    spec.compiler.degree = False  # joint ranges are in radians
    bodies = _add_bodies(spec, robot)
    for shape in robot.shapes:
        _add_shape(bodies[shape.body], shape, robot.tones[shape.tone])
    for point in robot.points:
        bodies[point.body].add_site(name=point.name, pos=point.pos)
    for joint in robot.joints:
        motor = spec.add_actuator(name=joint.id, target=joint.id, trntype=mujoco.mjtTrn.mjTRN_JOINT)
        motor.set_to_motor()
    if robot.imu is not None:
        _add_imu(spec, bodies[robot.imu.body], robot.imu)
    if robot.sole is not None:
        for side, foot in robot.feet.items():
            _add_sole(spec, bodies[foot.body], robot.sole, side)
    return spec


def sole_name(side: str) -> str:
    """Return the name of a side's sole: body, box and site."""
    return f"{side}_sole"


def _add_bodies(spec: mujoco.MjSpec, robot: RobotDescription) -> Mapping[str, mujoco.MjsBody]:
    """Add the tree of bodies with inertia and joints; return name -> body."""
    bodies = {WORLD: spec.worldbody}
    for body in robot.bodies:
        bodies[body.name] = _add_body(bodies[body.parent], body)
        joint = robot.joint_of(body.name)
        if joint is not None:
            bodies[body.name].add_joint(
                name=joint.id,
                type=mujoco.mjtJoint.mjJNT_HINGE,
                axis=joint.axis,
                armature=joint.armature,
                limited=mujoco.mjtLimited.mjLIMITED_TRUE,
                range=joint.range,
            )
    if robot.floating:
        bodies[robot.base].add_freejoint(name="base", align=mujoco.mjtAlignFree.mjALIGNFREE_FALSE)
    return bodies


def _add_body(parent: mujoco.MjsBody, body: BodyRow) -> mujoco.MjsBody:
    return parent.add_body(
        name=body.name,
        pos=body.pos,
        quat=body.quat,
        mass=body.mass,
        ipos=body.com,
        fullinertia=body.inertia,
        explicitinertial=True,
    )


def _add_shape(body: mujoco.MjsBody, shape: ShapeRow, colour: Colour) -> None:
    """Add a solid that is seen, weighs nothing and touches nothing."""
    geom = body.add_geom(
        name=shape.name, type=GEOM[shape.type], rgba=colour, group=SHAPE_GROUP, contype=0, conaffinity=0, mass=0
    )
    geom.size[: len(shape.size)] = shape.size
    if shape.segment is None:
        geom.pos = shape.pos
    else:
        geom.fromto = shape.segment


def _add_imu(spec: mujoco.MjSpec, base: mujoco.MjsBody, imu: ImuRow) -> None:
    """Add the inertial sensor: angular velocity [rad/s] and specific force [m/s^2] in base axes."""
    base.add_site(name="imu", pos=imu.pos)
    for name, kind in IMU_SENSORS.items():
        spec.add_sensor(name=f"imu_{name}", type=kind, objtype=mujoco.mjtObj.mjOBJ_SITE, objname="imu")


def _add_sole(spec: mujoco.MjSpec, foot: mujoco.MjsBody, shape: SoleRow, side: str) -> None:
    """Add the sole: a massless welded body, so that no inertia stands between the ground and the foot's sensor."""
    name = sole_name(side)
    sole = foot.add_body(name=name, explicitinertial=True)
    sole.add_geom(
        name=name,
        type=mujoco.mjtGeom.mjGEOM_BOX,
        pos=shape.box_centre,
        size=shape.box_half,
        contype=SOLE_TYPE,
        conaffinity=TERRAIN_TYPE,
        condim=SLIDING,
        group=SOLE_GROUP,
        mass=0,
    )
    sole.add_site(name=name, pos=shape.sensor_pos)
    for quantity, kind in FOOT_SENSORS.items():
        spec.add_sensor(name=f"{side}_foot_{quantity}", type=kind, objtype=mujoco.mjtObj.mjOBJ_SITE, objname=name)
