"""A robot's table from a URDF or a MJCF file, as MuJoCo reads it.

Links that no joint moves are one body with the link that carries them. What the file does not say, or a table cannot
hold, is told line by line.
"""

import re
import xml.etree.ElementTree as ET
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import mujoco
import numpy as np

from mobnet.core.errors import DataError, not_accepted
from mobnet.robot.import_sensors import feet_of, sensors_of

DRAWN = ("visual", "collision")  # parts of a URDF that need files of meshes and no table holds
ANGLE_RAD = 12.6  # range of a joint that turns without end: two turns, as wide as a table takes
MOST_NAME = 20  # letters of the name of a limb
PARTS = {"leg": {"hip", "knee", "ankle"}, "arm": {"shoulder", "elbow", "wrist"}}  # words of joints that tell a limb


@dataclass(frozen=True)
class Limits:
    """Largest torque [N m] and speed [rad/s] of a joint; None where the file says none."""

    torque: float | None = None
    speed: float | None = None


@dataclass
class Imported:
    """Rows of a table, what could not be read or is not taken over, and the model as MuJoCo reads it."""

    name: str
    bodies: list[dict[str, Any]]
    joints: list[dict[str, Any]]
    groups: dict[str, list[str]]
    floating: bool
    model: mujoco.MjModel
    notes: list[str] = field(default_factory=list)
    imu: dict[str, Any] | None = None


def import_robot(
    path: Path, floating: bool | None, torque_limit: float, speed_limit: float, armature: float = 0.0
) -> Imported:
    """Read a robot from a URDF or a MJCF file.

    Whether the base floats follows from the file if it is not said: a MJCF may have a free joint, a URDF has none.
    Limits [N m], [rad/s] and rotor inertia [kg m^2] are used for joints of which the file says none.

    Raises:
        DataError: the file is no robot that MuJoCo reads, or has no hinge.
    """
    text = _read(path)
    is_urdf = "<robot" in text
    notes: list[str] = []
    spec, limits = _urdf(path, text) if is_urdf else _mjcf(path)
    floats = _has_free_joint(spec) if floating is None else floating
    _set_base(spec, floats)
    notes += _weld_slides(spec)
    whole = _parsed(path, spec.copy().compile)
    model = _compiled(path, spec)
    notes += _set_armature(model, armature)
    joints = list(_joints(model, limits, torque_limit, speed_limit, notes))
    if not joints:
        raise DataError(f"{path}: no hinge; accepted: a robot whose joints turn")
    if is_urdf:
        base = "floating" if floats else "fixed"
        notes.append(f"the base is taken as {base}, which a URDF does not say; --base tells the other")
    bodies, imu = _bodies(model, spec, floats), None
    if floats:
        imu, other = sensors_of(whole)
        notes += [*other, *feet_of(whole, limbs(bodies, joints), joints)]
    notes += _left_out(model, imu is not None)
    name = re.sub(r"[^A-Za-z0-9 _.-]", "-", spec.modelname or path.stem)
    return Imported(name, bodies, joints, limbs(bodies, joints), floats, model, notes, imu)


def _read(path: Path) -> str:
    """Return the text of a file.

    Raises:
        DataError: it is missing, cannot be read or is no XML.
    """
    try:
        text = path.read_text(encoding="utf-8")
        ET.fromstring(text)
    except OSError as error:
        raise DataError(f"{path}: cannot be read: {error.strerror}; accepted: a URDF or MJCF file") from None
    except (UnicodeDecodeError, ET.ParseError) as error:
        raise DataError(f"{path}: {error}; accepted: a URDF or MJCF file") from None
    return text


def _urdf(path: Path, text: str) -> tuple[mujoco.MjSpec, dict[str, Limits]]:
    """Return the specification of a URDF without its shapes, and the limits of its joints."""
    root = ET.fromstring(text)
    for link in root.iter("link"):
        for part in [part for kind in DRAWN for part in link.findall(kind)]:
            link.remove(part)
    for old in root.findall("mujoco"):
        root.remove(old)
    for joint in root.findall("joint"):
        for coupling in joint.findall("mimic"):  # of gripper fingers, most of which slide
            joint.remove(coupling)
    compiler = {"fusestatic": "false", "balanceinertia": "false", "boundmass": "0", "boundinertia": "0"}
    ET.SubElement(ET.SubElement(root, "mujoco"), "compiler", compiler)
    limits = {}
    for joint in root.findall("joint"):
        found = joint.find("limit")
        told = {} if found is None else {key: float(value) for key, value in found.attrib.items()}
        limits[joint.get("name", "")] = Limits(told.get("effort") or None, told.get("velocity") or None)
    return _parsed(path, lambda: mujoco.MjSpec.from_string(ET.tostring(root, encoding="unicode"))), limits


def _mjcf(path: Path) -> tuple[mujoco.MjSpec, dict[str, Limits]]:
    """Return the specification of a MJCF file; limits of torque follow from its motors."""
    spec = _parsed(path, lambda: mujoco.MjSpec.from_file(str(path)))
    model = _compiled(path, spec.copy())
    limits = {}
    for k in range(model.njnt):
        name, torque = model.joint(k).name, np.inf
        if model.jnt_actfrclimited[k]:
            torque = float(np.abs(model.jnt_actfrcrange[k]).max())
        for a in range(model.nu):
            if model.actuator_trntype[a] == mujoco.mjtTrn.mjTRN_JOINT and model.actuator_trnid[a, 0] == k:
                torque = min(torque, _largest(model, a))
        limits[name] = Limits(torque if np.isfinite(torque) and torque > 0 else None)
    return spec, limits


def _largest(model: mujoco.MjModel, actuator: int) -> float:
    """Return the largest torque of an actuator [N m], infinite where it has no limit."""
    gear = abs(float(model.actuator_gear[actuator, 0]))
    if model.actuator_forcelimited[actuator]:
        return gear * float(np.abs(model.actuator_forcerange[actuator]).max())
    is_motor = model.actuator_biastype[actuator] == mujoco.mjtBias.mjBIAS_NONE
    if model.actuator_ctrllimited[actuator] and is_motor:
        gain = float(model.actuator_gainprm[actuator, 0])
        return gear * gain * float(np.abs(model.actuator_ctrlrange[actuator]).max())
    return np.inf


def _parsed(path: Path, parse: Any) -> mujoco.MjSpec:
    """Return a parsed specification, or raise what MuJoCo says in one line."""
    try:
        return parse()
    except (ValueError, mujoco.FatalError) as error:
        raise DataError(f"{path}: {' '.join(str(error).split())}; accepted: a file that MuJoCo reads") from None


def _compiled(path: Path, spec: mujoco.MjSpec) -> mujoco.MjModel:
    """Return the compiled model, static bodies fused."""
    spec.compiler.fusestatic = True
    return _parsed(path, spec.compile)


def _has_free_joint(spec: mujoco.MjSpec) -> bool:
    """Return whether the first body moves freely."""
    first = spec.worldbody.first_body()
    return any(joint.type == mujoco.mjtJoint.mjJNT_FREE for joint in first.joints)


def _set_base(spec: mujoco.MjSpec, floating: bool) -> None:
    """Let the first body move freely, or fix it to the world."""
    first = spec.worldbody.first_body()
    has = [joint for joint in first.joints if joint.type == mujoco.mjtJoint.mjJNT_FREE]
    if floating and not has:
        first.add_freejoint(name="free_base")
    for joint in has if not floating else ():
        spec.delete(joint)


def _weld_slides(spec: mujoco.MjSpec) -> Iterator[str]:
    """Weld what slides or is a ball, and yield what was welded."""
    kinds = {mujoco.mjtJoint.mjJNT_SLIDE: "slides", mujoco.mjtJoint.mjJNT_BALL: "is a ball"}
    for joint in list(spec.joints):
        if joint.type in kinds:
            yield f"{joint.name}: {kinds[joint.type]}; it is welded at zero, as a table holds hinges alone"
            spec.delete(joint)


def _bodies(model: mujoco.MjModel, spec: mujoco.MjSpec, floating: bool) -> list[dict[str, Any]]:
    """Return the rows of bodies; a table has joints at the origins of bodies, so that a frame is moved to its joint."""
    shifts = np.zeros((model.nbody, 3))
    for k in range(model.njnt):
        if model.jnt_type[k] == mujoco.mjtJoint.mjJNT_HINGE:
            shifts[model.jnt_bodyid[k]] = model.jnt_pos[k]
    names = {0: "world", **{b: _word(model.body(b).name, f"body_{b}") for b in range(1, model.nbody)}}
    rows = []
    if not floating:
        first = spec.worldbody.first_body()
        base = _word(first.name if first.name not in names.values() else "base", "base")
        names[0] = base
        # A base that stands still has no momentum; its mass only has to be some mass.
        rows.append(_row(base, "world", np.zeros(3), [1.0, 0, 0, 0], 1.0, np.zeros(3), [0.01, 0.01, 0.01, 0, 0, 0]))
    for b in _with_mass(model):
        parent = int(model.body_parentid[b])
        turn = np.zeros(9)
        mujoco.mju_quat2Mat(turn, model.body_quat[b])
        pos = model.body_pos[b] + turn.reshape(3, 3) @ shifts[b] - shifts[parent]
        com = model.body_ipos[b] - shifts[b]
        own = float(model.body_mass[b])
        rows.append(_row(names[b], names[parent], pos, model.body_quat[b], own, com, _inertia(model, b)))
    return rows


def _with_mass(model: mujoco.MjModel) -> list[int]:
    """Return the bodies with a mass or with one below them; others are frames that something refers to."""
    return (np.flatnonzero(model.body_subtreemass[1:] > 0.0) + 1).tolist()


def _row(name: str, parent: str, pos: Any, quat: Any, mass: float, com: Any, inertia: Any) -> dict[str, Any]:
    """Return the row of a body, in SI units."""
    lists = {"pos": pos, "quat": quat, "com": com, "inertia": inertia}
    listed = {key: [float(x) for x in value] for key, value in lists.items()}
    return {"name": name, "parent": parent, **listed, "mass": mass}


def _inertia(model: mujoco.MjModel, b: int) -> list[float]:
    """Return xx yy zz xy xz yz about the centre of mass, body axes [kg m^2]."""
    turn = np.zeros(9)
    mujoco.mju_quat2Mat(turn, model.body_iquat[b])
    axes = turn.reshape(3, 3)
    full = axes @ np.diag(model.body_inertia[b]) @ axes.T
    return [float(full[i, j]) for i, j in ((0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2))]


def _joints(
    model: mujoco.MjModel, limits: Mapping[str, Limits], torque_limit: float, speed_limit: float, notes: list[str]
) -> Iterator[dict[str, Any]]:
    """Yield the rows of hinges in their order, and note of which the file says no limit."""
    unlimited: dict[str, list[str]] = {"range": [], "torque": [], "speed": []}
    for k in range(model.njnt):
        if model.jnt_type[k] != mujoco.mjtJoint.mjJNT_HINGE:
            continue
        name = model.joint(k).name
        own, word = limits.get(name, Limits()), _word(name, f"joint_{k}")
        low, high = (float(x) for x in model.jnt_range[k])
        if not model.jnt_limited[k] or high - low > 2 * ANGLE_RAD:
            low, high = -ANGLE_RAD, ANGLE_RAD
            unlimited["range"].append(word)
        unlimited["torque"] += [] if own.torque else [word]
        unlimited["speed"] += [] if own.speed else [word]
        yield {
            "id": word, "name": name, "body": _word(model.body(model.jnt_bodyid[k]).name, ""),
            "axis": [float(x) for x in model.jnt_axis[k]], "range": [low, high],
            "torque_limit": own.torque or torque_limit, "armature": float(model.dof_armature[model.jnt_dofadr[k]]),
            "velocity_limit": own.speed or speed_limit,
        }  # fmt: skip
    taken = {"range": f"{ANGLE_RAD} rad", "torque": f"{torque_limit:g} N m", "speed": f"{speed_limit:g} rad/s"}
    for kind, names in unlimited.items():
        if names:
            notes.append(f"{kind} of {', '.join(names)}: not in the file, {taken[kind]} is taken")


def _set_armature(model: mujoco.MjModel, armature: float) -> Iterator[str]:
    """Give joints without a rotor inertia another one [kg m^2], and yield what was done."""
    hinges = model.jnt_dofadr[model.jnt_type == mujoco.mjtJoint.mjJNT_HINGE]
    without = hinges[model.dof_armature[hinges] == 0.0]
    model.dof_armature[without] = armature
    if armature and len(without):
        which = "all joints" if len(without) == len(hinges) else f"{len(without)} of {len(hinges)} joints"
        yield f"armature of {which}: not in the file, {armature:g} kg m^2 is taken"


def _left_out(model: mujoco.MjModel, has_imu: bool) -> Iterator[str]:
    """Yield what the file has and a table does not hold."""
    hinges = [model.jnt_dofadr[k] for k in range(model.njnt) if model.jnt_type[k] == mujoco.mjtJoint.mjJNT_HINGE]
    for name, values in (("damping", model.dof_damping), ("dry friction", model.dof_frictionloss)):
        if np.any(values[hinges]):
            yield f"{name} of joints: not taken over; networks learn it"
    if not model.dof_armature[hinges].any():
        yield "armature: zero for all joints; add the rotors' inertia, reflected to the joints, where gears are high"
    if model.neq:
        yield f"{model.neq} equality constraints (closed chains): not taken over"
    rest = ["feet", "sole", *([] if has_imu else ["imu"]), "leg", "hands", "posture", "shapes", "points"]
    yield f"{', '.join(rest)}: not in the file; docs/robots.md says what needs them"


def _word(name: str, otherwise: str) -> str:
    """Return a name as a table takes it."""
    word = re.sub(r"\W", "_", name, flags=re.ASCII).strip("_") or otherwise
    return (word if word[0].isalpha() else f"b_{word}")[:50]


def limbs(bodies: Sequence[Mapping[str, Any]], joints: Sequence[Mapping[str, Any]]) -> dict[str, list[str]]:
    """Return limb -> its joints: chains without a branch, named by what the names of their joints have in common."""
    moved = {joint["body"]: joint["id"] for joint in joints}
    parents = {body["name"]: body["parent"] for body in bodies}
    children: dict[str, list[str]] = {}
    for body in bodies:
        if body["name"] in moved:
            carrier = body["parent"]
            while carrier in parents and carrier not in moved:
                carrier = parents[carrier]
            children.setdefault(carrier, []).append(body["name"])
    found: dict[str, list[str]] = {}

    def follow(body: str, chain: list[str]) -> None:
        below = children.get(body, [])
        if body in moved:
            chain.append(moved[body])
        if len(below) == 1 and body in moved:
            follow(below[0], chain)
            return
        if chain:
            found[_limb_name(chain, [*found, *moved.values()])] = list(chain)
        for child in below:
            follow(child, [])

    for root in [body for body in children if body not in moved]:
        for child in children[root]:
            follow(child, [])
    return found


def _limb_name(chain: Sequence[str], taken: Iterable[str]) -> str:
    """Return a name for a chain that no other limb and no joint has."""
    parts = [re.findall(r"[A-Za-z0-9]+", joint) for joint in chain]
    shared = [word for word in parts[0] if all(word in other for other in parts) and word.lower() != "joint"]
    words = {word.lower() for own in parts for word in own}
    shared += [part for part, marks in PARTS.items() if shared and marks & words and part not in shared]
    stem = "".join(shared)[: MOST_NAME - 2] if shared and shared[0][0].isalpha() else "limb"
    lowered = {name.casefold() for name in taken}
    name, number = stem, 2
    while name.casefold() in lowered:
        name, number = f"{stem}{number}", number + 1
    return name


def check_base(word: str | None) -> bool | None:
    """Return whether the base floats, by what a user said; None where nothing was said.

    Raises:
        DataError: it is neither of the two.
    """
    kinds = {None: None, "floating": True, "fixed": False}
    if word not in kinds:
        raise DataError(not_accepted("--base", word, ["fixed", "floating"]))
    return kinds[word]
