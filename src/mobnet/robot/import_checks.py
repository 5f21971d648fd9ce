"""By how much a table differs from what Pinocchio and MuJoCo read of the robot's file by themselves.

A URDF is given to them without shapes and under other names, with the numbers of the file: names may be equal
or foreign there, and a limit may be missing. What the import has changed, and told, is changed in their models too.
"""

import copy
import xml.etree.ElementTree as ET
from collections.abc import Callable, Iterator
from itertools import chain
from typing import Any

import mujoco
import numpy as np
import pinocchio as pin
from numpy.typing import NDArray

from mobnet.core.arrays import Array
from mobnet.core.errors import DataError
from mobnet.robot.description import RobotDescription
from mobnet.robot.dynamics import bias, mass_matrix
from mobnet.robot.import_file import RobotFile
from mobnet.robot.import_inertia import balanced
from mobnet.robot.import_links import Imported
from mobnet.robot.import_mjcf import GRAVITY, compiled, spec_of
from mobnet.robot.import_tree import FREE
from mobnet.robot.import_urdf import MOMENTS
from mobnet.robot.nominal import NominalModel

POSES, SEED, SPEED = 5, 1, 2.0  # at which models are compared, and their largest velocity [m/s], [rad/s]
LEAST_RAD_S2 = 1.0  # where no torque is larger, that of this acceleration is what a bias is a share of
TURNING = (int(mujoco.mjtJoint.mjJNT_HINGE), int(mujoco.mjtJoint.mjJNT_SLIDE))
BASE = 6  # velocities of a floating base
Terms = Callable[[Array, Array], tuple[Array, Array]]  # (q, v) of a table -> its mass matrix, its bias
FAULTS = (DataError, ValueError, RuntimeError, KeyError, IndexError, mujoco.FatalError)


def differences(
    robot: RobotDescription, imported: Imported, notes: list[str] | None = None
) -> Iterator[tuple[str, float, float]]:
    """Yield another reading of a file, and by how much mass matrix and bias of the table differ from it.

    Both are shares of the largest entry, over some random poses. A reading that cannot be made is noted.
    """
    file = imported.file
    if file is None:
        return
    nominal = NominalModel(robot, gravity_m_s2=-GRAVITY[2])
    readings = {"Pinocchio": _pinocchio, "MuJoCo": _mujoco} if imported.kind == "URDF" else {"MuJoCo": _mujoco}
    for name, read in readings.items():
        try:
            inertia, terms = _compared(nominal, read(robot, imported, file))
        except FAULTS as error:
            if notes is not None:
                said = " ".join(str(error).split()).partition("; accepted")[0]
                notes.append(f"not compared with {name}'s own reading: {said}")
        else:
            yield name, inertia, terms


def _compared(nominal: NominalModel, read: Terms) -> tuple[float, float]:
    """Return the largest differences of mass matrix and bias over some poses."""
    rng = np.random.default_rng(SEED)
    rows = list[tuple[float, float]]()
    for _ in range(POSES):
        q, v = _pose(nominal.robot, rng)
        inertia, terms = read(q, v)
        largest = float(np.abs(inertia).max())
        least = LEAST_RAD_S2 * largest
        rows.append((_apart(mass_matrix(nominal, q), inertia, largest), _apart(bias(nominal, q, v), terms, least)))
    inertia, terms = np.max(rows, axis=0).tolist()
    return inertia, terms


def _pose(robot: RobotDescription, rng: np.random.Generator) -> tuple[Array, Array]:
    """Return a random position (nq,) within the joints' ranges and a random velocity (nv,)."""
    low, high = np.array([joint.range for joint in robot.joints]).T
    angles = rng.uniform(np.maximum(low, -np.pi), np.minimum(high, np.pi))
    base = np.concatenate([rng.normal(size=3), _unit(rng.normal(size=4))]) if robot.floating else np.zeros(0)
    return np.concatenate([base, angles]), rng.uniform(-SPEED, SPEED, robot.layout.nv)


def _unit(vector: Array) -> Array:
    return vector / np.linalg.norm(vector)


def _apart(one: Array, other: Array, least: float) -> float:
    """Return the largest difference, a share of the largest entry or of a least one."""
    return float(np.abs(one - other).max() / max(np.abs(other).max(), least))


def _pinocchio(robot: RobotDescription, imported: Imported, file: RobotFile) -> Terms:
    """Return mass matrix and bias by Pinocchio's own reading of a URDF."""
    text = _plain(file.root, imported)
    whole = pin.buildModelFromXML(text, pin.JointModelFreeFlyer()) if robot.floating else pin.buildModelFromXML(text)
    names = ["root_joint"] * robot.floating + [f"j{joint.index}" for joint in imported.hinges]
    locked = [k for k, name in enumerate(whole.names) if k and name not in names]
    start = pin.neutral(whole)
    for index, value in imported.robot.held.items():
        if whole.existJointName(f"j{index}"):
            _set(whole, start, whole.getJointId(f"j{index}"), value)
    model = pin.buildReducedModel(whole, locked, start)
    numbers = [model.getJointId(name) for name in names]
    for number, mass in zip(numbers[::-1], imported.masses[::-1], strict=False):  # a base that stands still is none
        body = model.inertias[number]
        if mass.is_changed and not mass.dropped:
            changed, moments = balanced(body.mass, body.inertia)
            model.inertias[number] = pin.Inertia(changed, body.lever, moments)
    data = model.createData()
    columns = np.concatenate([_columns(model, number) for number in numbers])

    def terms(q: Array, v: Array) -> tuple[Array, Array]:
        body = pin.neutral(model)
        speeds = np.zeros(model.nv)
        turn = np.eye(model.nv)
        angles = q[len(q) - robot.layout.nu :]
        base = np.zeros(model.nv)
        speeds[columns] = v
        for number, angle in zip(numbers[robot.floating :], angles, strict=True):
            _set(model, body, number, angle)
        if robot.floating:  # its velocity is in the base's axes there
            body[:7] = q[[0, 1, 2, 4, 5, 6, 3]]
            turn[:3, :3] = pin.Quaternion(body[3:7]).matrix().T
            speeds[:3] = turn[:3, :3] @ v[:3]
            base[:3] = -np.cross(speeds[3:6], speeds[:3])
        upper = np.triu(pin.crba(model, data, body))
        inertia = upper + np.triu(upper, 1).T
        bias_terms = turn.T @ (pin.nonLinearEffects(model, data, body, speeds) + inertia @ base)
        inertia = (turn.T @ inertia @ turn)[np.ix_(columns, columns)]
        return inertia + np.diag([*np.zeros(len(v) - robot.layout.nu), *robot.armature]), bias_terms[columns]

    return terms


def _columns(model: Any, number: int) -> NDArray[np.intp]:
    """Return where the velocity of a joint stands."""
    joint = model.joints[number]
    return np.arange(joint.idx_v, joint.idx_v + joint.nv)


def _set(model: Any, q: Array, number: int, value: float) -> None:
    """Set a joint in a position of Pinocchio's, which holds one without end as its cosine and sine."""
    joint = model.joints[number]
    if joint.nq == 1:
        q[joint.idx_q] = value
    elif joint.nv == 1:
        q[joint.idx_q : joint.idx_q + 2] = np.cos(value), np.sin(value)


def _plain(root: ET.Element, imported: Imported) -> str:
    """Return a URDF with the links l0, l1 and the joints j0, j1 of a robot, and with the numbers of its file."""
    names = {link.name: k for k, link in enumerate(imported.tree.links)}
    dropped = set(chain.from_iterable(mass.dropped for mass in imported.masses))
    plain = ET.Element("robot", name="robot")
    if _has_quaternions(root):
        plain.set("version", root.get("version", ""))
    for row in root.findall("link"):
        number = names[row.get("name", "")]
        inertial = row.find("inertial")
        if imported.robot.kept[number]:
            link = ET.SubElement(plain, "link", name=f"l{number}")
            if inertial is not None and number not in dropped:
                link.append(_whole(inertial))
    for index, row in enumerate(root.findall("joint")):
        child = names[_end(row, "child")]
        if imported.robot.kept[child] and child != imported.robot.base:
            kind = {"floating": "fixed", "planar": "fixed"}.get(row.get("type", ""), row.get("type", ""))
            joint = ET.SubElement(plain, "joint", name=f"j{index}", type=kind)
            for end in ("parent", "child"):
                ET.SubElement(joint, end, link=f"l{names[_end(row, end)]}")
            joint.extend(map(copy.deepcopy, [*row.findall("origin"), *row.findall("axis")]))
            if kind in ("revolute", "prismatic"):
                ET.SubElement(joint, "limit", lower="-1", upper="1", effort="1", velocity="1")
    return ET.tostring(plain, encoding="unicode")


def _has_quaternions(root: ET.Element) -> bool:
    """Return whether a place in a URDF has a quaternion."""
    return any("quat_xyzw" in origin.attrib for origin in root.iter("origin"))


def _end(joint: ET.Element, end: str) -> str:
    element = joint.find(end)
    return "" if element is None else element.get("link", "")


def _whole(inertial: ET.Element) -> ET.Element:
    """Return the mass of a link, zeros where the file leaves numbers out."""
    whole = copy.deepcopy(inertial)
    for tag, keys in (("mass", ("value",)), ("inertia", MOMENTS)):
        row = whole.find(tag)
        row = ET.SubElement(whole, tag) if row is None else row
        for key in keys:
            row.set(key, row.get(key, "0"))
    return whole


def _mujoco(robot: RobotDescription, imported: Imported, file: RobotFile) -> Terms:
    """Return mass matrix and bias by MuJoCo's own reading of a file."""
    model = _model(imported, file)
    joints = {
        joint.index: _number(model, imported, joint.index) for joint in imported.tree.joints() if joint.kind != FREE
    }
    hinges = [joints[joint.index] for joint in imported.hinges]
    places = {joints.get(index, -1): value for index, value in imported.robot.held.items()}
    locked = {
        int(model.jnt_qposadr[k]): value for k, value in places.items() if k >= 0 and model.jnt_type[k] in TURNING
    }
    _change(model, imported)
    model.opt.gravity[:] = GRAVITY
    model.opt.disableflags = mujoco.mjtDisableBit.mjDSBL_CONTACT | mujoco.mjtDisableBit.mjDSBL_CONSTRAINT
    model.tendon_armature[:] = 0.0
    dofs = model.jnt_dofadr[hinges]
    model.dof_armature[dofs] = robot.armature
    data = mujoco.MjData(model)
    first = 0
    if robot.floating:
        body = _body(model, imported, imported.robot.base)
        first = int(model.body_jntadr[body])
        model.dof_armature[np.arange(BASE) + model.jnt_dofadr[first]] = 0.0  # no rotor moves a base
        dofs = np.concatenate([np.arange(BASE) + model.jnt_dofadr[first], dofs])

    def terms(q: Array, v: Array) -> tuple[Array, Array]:
        data.qpos[:] = model.qpos0
        data.qvel[:] = 0.0
        data.qpos[list(locked)] = list(locked.values())
        data.qpos[model.jnt_qposadr[hinges]] = q[len(q) - robot.layout.nu :]
        data.qvel[dofs] = v
        if robot.floating:
            data.qpos[model.jnt_qposadr[first] + np.arange(7)] = q[:7]
        mujoco.mj_forward(model, data)
        inertia = np.zeros((model.nv, model.nv))
        mujoco.mj_fullM(model, data, inertia)
        return inertia[np.ix_(dofs, dofs)], data.qfrc_bias[dofs].copy()

    return terms


def _model(imported: Imported, file: RobotFile) -> mujoco.MjModel:
    """Return MuJoCo's model of a file, its base free where the robot floats."""
    if imported.kind == "URDF":
        if _has_quaternions(file.root):
            raise DataError("it takes no notice of quat_xyzw")
        spec = mujoco.MjSpec.from_string(_plain(file.root, imported))
        spec.compiler.fusestatic = False
    else:
        spec = spec_of(file)
    if imported.floating:
        link = imported.tree.links[imported.robot.base]
        if imported.kind == "URDF":
            spec.body(f"l{imported.robot.base}").add_freejoint()
        elif not link.joints:
            spec.bodies[imported.robot.base + 1].add_freejoint()
    return compiled(spec)


def _number(model: mujoco.MjModel, imported: Imported, index: int) -> int:
    """Return the number of a joint, -1 without one: a URDF is given to MuJoCo under other names."""
    if imported.kind == "URDF":
        return mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_JOINT, f"j{index}")
    added = imported.floating and not imported.tree.links[imported.robot.base].joints
    return index + int(added and index >= model.body_jntadr[imported.robot.base + 1])


def _body(model: mujoco.MjModel, imported: Imported, link: int) -> int:
    """Return the number of a link's body."""
    if imported.kind == "URDF":
        return mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_BODY, f"l{link}")
    return link + 1


def _change(model: mujoco.MjModel, imported: Imported) -> None:
    """Give the first link of each body that the import has changed the mass of all of the body."""
    for body, mass in zip(imported.parts, imported.masses, strict=True):
        if mass.is_changed:
            first = body.parts[0]
            for part in body.parts:
                number = _body(model, imported, part.link)
                model.body_mass[number] = 0.0
                model.body_inertia[number] = 0.0
            number = _body(model, imported, first.link)
            moments, axes = np.linalg.eigh(first.turn.T @ mass.inertia @ first.turn)
            axes[:, 0] *= np.sign(np.linalg.det(axes))
            model.body_mass[number] = mass.mass
            model.body_inertia[number] = moments
            model.body_ipos[number] = first.turn.T @ (mass.com - first.pos)
            model.body_iquat[number] = pin.Quaternion(axes).coeffs()[[3, 0, 1, 2]]
