"""The links and joints of a MJCF file, from the model that MuJoCo makes of it."""

import warnings
from collections.abc import Callable, Iterator, Mapping
from pathlib import Path
from typing import TypeVar

import mujoco
import numpy as np

from mobnet.core.arrays import Array
from mobnet.core.errors import DataError
from mobnet.robot.import_file import RobotFile
from mobnet.robot.import_tree import BALL, FREE, HINGE, SLIDE, WORLD, Follows, Joint, Link, LinkTree, Site

KINDS = {  # an enumerator of MuJoCo equals no integer of numpy that is on its right
    int(mujoco.mjtJoint.mjJNT_HINGE): HINGE,
    int(mujoco.mjtJoint.mjJNT_SLIDE): SLIDE,
    int(mujoco.mjtJoint.mjJNT_BALL): BALL,
    int(mujoco.mjtJoint.mjJNT_FREE): FREE,
}
INERTIAL = (int(mujoco.mjtSensor.mjSENS_ACCELEROMETER), int(mujoco.mjtSensor.mjSENS_GYRO))
OF_JOINTS = (int(mujoco.mjtTrn.mjTRN_JOINT), int(mujoco.mjtTrn.mjTRN_JOINTINPARENT))
GRAVITY = (0.0, 0.0, -9.81)  # [m/s^2], of the table's models
NEAR = 0.05  # [m/s^2]: 9.8 and 9.81 are the same
# MuJoCo takes no body that moves without mass; these change no mass matrix in its first ten digits, [kg] and [kg m^2]
BOUND_MASS = 1e-12
BOUND_INERTIA = 1e-14
CORNERS = np.array([0.0, 0, 0, 0.1, 0, 0, 0, 0.1, 0, 0, 0, 0.1])  # of the tetrahedron in place of a mesh [m]
FACES = np.array([0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3])
SMALL_TEXTURE, CUBE_SIDES = 8, 6  # [pixels]
Made = TypeVar("Made")


def read_mjcf(file: RobotFile) -> LinkTree:
    """Return the bodies of a MJCF file as links.

    Raises:
        DataError: MuJoCo does not read it.
    """
    spec = spec_of(file)
    model = compiled(spec)
    couplings = _couplings(model)
    tree = LinkTree(spec.modelname, [_link(model, b, couplings) for b in range(1, model.nbody)])
    measured = {int(model.sensor_objid[k]) for k in range(model.nsensor) if model.sensor_type[k] in INERTIAL}
    for k in range(model.nsite):
        if model.site_bodyid[k] > 0:
            link = int(model.site_bodyid[k]) - 1
            tree.sites.append(
                Site(model.site(k).name, link, model.site_pos[k].copy(), _turn(model.site_quat[k]), k in measured)
            )
    tree.chains = int(model.neq) - len(couplings)
    tree.notes += _gravity(model)
    tree.notes += _not_modelled(model)
    return tree


def spec_of(file: RobotFile) -> mujoco.MjSpec:
    """Return the specification of a file without what says nothing about its masses: pictures, heights, keyframes.

    A mesh that no mass follows from is a tetrahedron, so that its file may be missing.
    """
    if file.is_stored:
        spec = _or_one_line(lambda: mujoco.MjSpec.from_file(str(file.path)))
    else:
        spec = _or_one_line(lambda: mujoco.MjSpec.from_string(file.text))
    spec.memory = -1  # as much as it takes
    spec.compiler.fusestatic = False
    spec.compiler.boundmass = max(spec.compiler.boundmass, BOUND_MASS)
    spec.compiler.boundinertia = max(spec.compiler.boundinertia, BOUND_INERTIA)
    for row in (*spec.keys, *spec.skins):
        spec.delete(row)
    for texture in spec.textures:
        is_flat = texture.type == mujoco.mjtTexture.mjTEXTURE_2D
        texture.file = ""
        texture.content_type = ""
        texture.cubefiles = [""] * CUBE_SIDES
        texture.builtin = mujoco.mjtBuiltin.mjBUILTIN_FLAT
        texture.width = SMALL_TEXTURE
        texture.height = SMALL_TEXTURE * (1 if is_flat else CUBE_SIDES)
    for field in spec.hfields:
        field.file = ""
        field.content_type = ""
        field.nrow = 2
        field.ncol = 2
        field.userdata = [0.0] * 4
    weighed = _weighed(spec)
    for mesh in spec.meshes:
        if mesh.file and _name(mesh) not in weighed:
            mesh.name = _name(mesh)
            mesh.file = ""
            mesh.content_type = ""
            mesh.uservert = CORNERS
            mesh.userface = FACES
    return spec


def compiled(spec: mujoco.MjSpec) -> mujoco.MjModel:
    """Return the model of a specification.

    Raises:
        DataError: MuJoCo does not take it.
    """
    bodies = sorted(set(_weighed(spec).values()))  # beforehand, as nothing can be asked of one that did not compile
    try:
        return _or_one_line(spec.compile)
    except DataError as error:
        if "opening file" not in str(error) or not bodies:
            raise
        raise DataError(f"{error}; or an <inertial> of the bodies whose masses follow from meshes: {bodies}") from None


def _or_one_line(make: Callable[[], Made]) -> Made:
    """Return what MuJoCo makes, or raise what it says in one line."""
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # of what is old in a file
            return make()
    except (ValueError, RuntimeError, MemoryError, mujoco.FatalError) as error:
        raise DataError(f"{' '.join(str(error).split())}; accepted: a file that MuJoCo reads") from None


def _name(mesh: mujoco.MjsMesh) -> str:
    """Return the name of a mesh, which is that of its file where it has none."""
    return mesh.name or Path(mesh.file.replace("\\", "/")).stem


def _weighed(spec: mujoco.MjSpec) -> dict[str, str]:
    """Return the meshes from which the mass of a body follows, with the body."""
    always = spec.compiler.inertiafromgeom == mujoco.mjtInertiaFromGeom.mjINERTIAFROMGEOM_TRUE
    meshes = {}
    for body in spec.bodies[1:]:
        if always or not body.explicitinertial:
            meshes |= {geom.meshname: body.name for geom in body.geoms if geom.meshname}
    return meshes


def _link(model: mujoco.MjModel, b: int, couplings: Mapping[int, Follows]) -> Link:
    """Return a body with its joints and its mass, none where MuJoCo took the least one."""
    first = int(model.body_jntadr[b])
    count = int(model.body_jntnum[b])
    joints = [_joint(model, k, couplings) for k in range(first, first + count)] if count else []
    axes = _turn(model.body_iquat[b])
    mass = float(model.body_mass[b])
    inertia = axes @ np.diag(model.body_inertia[b]) @ axes.T
    if mass <= BOUND_MASS:
        mass = 0.0
    if model.body_inertia[b].max() <= BOUND_INERTIA:
        inertia = np.zeros((3, 3))
    return Link(
        name=model.body(b).name,
        parent=int(model.body_parentid[b]) - 1 if model.body_parentid[b] else WORLD,
        pos=model.body_pos[b].copy(),
        turn=_turn(model.body_quat[b]),
        joints=joints,
        mass=mass,
        com=model.body_ipos[b].copy(),
        inertia=inertia,
    )


def _turn(quat: Array) -> Array:
    """Return the rotation (3, 3) of a quaternion w x y z."""
    turn = np.zeros(9)
    mujoco.mju_quat2Mat(turn, quat)
    return turn.reshape(3, 3)


def _joint(model: mujoco.MjModel, k: int, couplings: Mapping[int, Follows]) -> Joint:
    """Return a joint; its largest torque follows from its motors."""
    dof = int(model.jnt_dofadr[k])
    actuators = list(_actuators(model, k))
    torques = [_largest(model, a) for a in actuators]
    if model.jnt_actfrclimited[k]:
        torques.append(float(np.abs(model.jnt_actfrcrange[k]).max()))
    kind = KINDS[int(model.jnt_type[k])]
    return Joint(
        name=model.joint(k).name,
        kind=kind,
        axis=model.jnt_axis[k].copy(),
        index=k,
        pos=model.jnt_pos[k].copy(),
        at=float(model.qpos0[model.jnt_qposadr[k]]) if kind in (HINGE, SLIDE) else 0.0,
        range=(float(model.jnt_range[k, 0]), float(model.jnt_range[k, 1])) if model.jnt_limited[k] else None,
        torque=min(torques, default=None),
        armature=float(model.dof_armature[dof]),
        damping=float(np.ravel(model.dof_damping[dof])[0]),
        friction=float(model.dof_frictionloss[dof]),
        stiffness=float(np.ravel(model.jnt_stiffness[k])[0]),
        has_motor=bool(actuators) or not model.nu,
        follows=None if actuators else couplings.get(k),
    )


def _actuators(model: mujoco.MjModel, joint: int) -> Iterator[int]:
    """Yield the actuators that act on a joint."""
    for a in range(model.nu):
        if model.actuator_trntype[a] in OF_JOINTS and model.actuator_trnid[a, 0] == joint:
            yield a


def _largest(model: mujoco.MjModel, actuator: int) -> float:
    """Return the largest torque of an actuator behind its gear [N m], infinite where it has no limit."""
    gear = abs(float(model.actuator_gear[actuator, 0]))
    largest = np.inf
    if model.actuator_forcelimited[actuator]:
        largest = float(np.abs(model.actuator_forcerange[actuator]).max())
    is_motor = model.actuator_biastype[actuator] == mujoco.mjtBias.mjBIAS_NONE
    if model.actuator_ctrllimited[actuator] and is_motor:
        gain = abs(float(model.actuator_gainprm[actuator, 0]))
        largest = min(largest, gain * float(np.abs(model.actuator_ctrlrange[actuator]).max()))
    return gear * largest


def _couplings(model: mujoco.MjModel) -> dict[int, Follows]:
    """Return what joints do that an equality constraint ties to another joint, or to one coordinate."""
    couplings = {}
    for k in range(model.neq):
        if model.eq_type[k] == mujoco.mjtEq.mjEQ_JOINT and model.eq_active0[k]:
            joint = int(model.eq_obj1id[k])
            leader = int(model.eq_obj2id[k])
            offset, factor = (float(value) for value in model.eq_data[k, :2])
            offset += float(model.qpos0[model.jnt_qposadr[joint]])  # both count from where the file places the joints
            if leader < 0:
                couplings[joint] = Follows(None, 0.0, offset)
            else:
                couplings[joint] = Follows(
                    leader, factor, offset - factor * float(model.qpos0[model.jnt_qposadr[leader]])
                )
    return couplings


def _gravity(model: mujoco.MjModel) -> Iterator[str]:
    """Yield that the file has another gravity than the table's models."""
    if np.abs(model.opt.gravity - GRAVITY).max() > NEAR:
        numbers = ", ".join(f"{value:g}" for value in model.opt.gravity)
        yield f"gravity of the file, [{numbers}] m/s^2, is not taken over; a table's z is up, with 9.81 m/s^2 down"


def _not_modelled(model: mujoco.MjModel) -> Iterator[str]:
    """Yield forces of the file that a table does not hold, those of single joints left aside."""
    carried = [model.body(b).name or f"body {b}" for b in range(1, model.nbody) if model.body_gravcomp[b]]
    if carried:
        yield f"gravcomp of {', '.join(carried)}: not taken over; bodies of a table have all of their weight"
    if model.opt.density or model.opt.viscosity:
        numbers = f"density {model.opt.density:g} kg/m^3, viscosity {model.opt.viscosity:g} Pa s"
        yield f"fluid, {numbers}: not taken over; networks learn its drag"
    if np.any(model.tendon_stiffness):
        yield "springs of tendons: not taken over; networks learn them"
