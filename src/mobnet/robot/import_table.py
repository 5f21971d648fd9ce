"""A robot's table from a URDF or MJCF file: `./reproduce robot FILE` (docs/robots.md)."""

import logging
import sys
from argparse import Namespace
from collections.abc import Iterator
from pathlib import Path
from typing import Any

import mujoco
import numpy as np
import pinocchio as pin

from mobnet.core.errors import ConfigError
from mobnet.core.files import atomic_path
from mobnet.core.flow import flow
from mobnet.core.joints import N_VIRTUAL
from mobnet.robot.description import RobotDescription, describe
from mobnet.robot.dynamics import bias, mass_matrix
from mobnet.robot.import_words import import_parser
from mobnet.robot.importing import Imported, check_base, import_robot
from mobnet.robot.nominal import NominalModel
from mobnet.running.printed import printed
from mobnet.settings.load import load_section
from mobnet.settings.robot import RobotTable

log = logging.getLogger(__name__)
VIRTUAL = [f"V{k + 1}" for k in range(N_VIRTUAL)]
BASE_LIMB = "V"
POSES, SEED, SPEED = 5, 1, 2.0  # at which models are compared, and their largest velocity [m/s], [rad/s]
GRAVITY_M_S2 = 9.81


def table_text(found: Imported, source: str) -> str:
    """Return the YAML of a table: a line for each body and each joint."""
    limbs = {**({BASE_LIMB: VIRTUAL} if found.floating else {}), **found.groups}
    order = {**({"virtual": VIRTUAL} if found.floating else {}), "actuated": [row["id"] for row in found.joints]}
    networks = {name: {"joints": [name], "Q": [name], "T": []} for name in found.groups}
    lines = [
        f"# {found.name}: from {_line(source)}, by ./reproduce robot. SI units; quaternions w x y z.",
        "# inertia: [xx, yy, zz, xy, xz, yz] about the centre of mass, in body axes.",
        *(f"# {_line(note)}" for note in found.notes),
        f"name: {flow(found.name)}",
        f"base: {'floating' if found.floating else 'fixed'}",
        *([f"imu: {flow(found.imu)}"] if found.imu else []),
        "order:", *(f"  {key}: {flow(value)}" for key, value in order.items()),
        "groups:", *(f"  {name}: {flow(joints)}" for name, joints in limbs.items()),
        "networks:", *(f"  {name}: {flow(row)}" for name, row in networks.items()),
        "joints:", *(f"  - {flow(row)}" for row in found.joints),
        "bodies:", *(f"  - {flow(row)}" for row in found.bodies),
    ]  # fmt: skip
    return "\n".join(lines) + "\n"


def _line(text: str) -> str:
    """Return a text on one line: names in a file may hold line breaks, which would end a comment."""
    return " ".join(text.split())


def differences(robot: RobotDescription, found: Imported, path: Path) -> Iterator[tuple[str, float, float]]:
    """Yield another reading of a file, and by how much mass matrix and bias of the table differ from it.

    Both are shares of the largest entry, over some random poses.
    """
    nominal, model = NominalModel(robot, gravity_m_s2=GRAVITY_M_S2), found.model
    model.opt.gravity[:] = 0.0, 0.0, -GRAVITY_M_S2
    data = mujoco.MjData(model)
    rng, rows = np.random.default_rng(SEED), list[tuple[float, float]]()
    for _ in range(POSES):
        q, v = _pose(robot, rng)
        data.qpos[:], data.qvel[:] = q, v
        mujoco.mj_forward(model, data)
        inertia = np.zeros((model.nv, model.nv))
        mujoco.mj_fullM(model, data, inertia)
        rows.append((_apart(mass_matrix(nominal, q), inertia), _apart(bias(nominal, q, v), data.qfrc_bias)))
    yield ("MuJoCo", *np.max(rows, axis=0).tolist())
    if path.suffix.lower() == ".urdf" and not robot.floating:
        yield ("Pinocchio", *_pinocchio(robot, nominal, path))


def _pinocchio(robot: RobotDescription, nominal: NominalModel, path: Path) -> tuple[float, float]:
    """Return by how much the table differs from Pinocchio's own reading of a URDF; its other joints stand at zero."""
    whole = pin.buildModelFromUrdf(str(path))
    names = [joint.name or joint.id for joint in robot.joints]
    locked = [k for k, name in enumerate(whole.names) if k and name not in names]
    model = pin.buildReducedModel(whole, locked, pin.neutral(whole))
    data, rng, rows = model.createData(), np.random.default_rng(SEED), list[tuple[float, float]]()
    order = [names.index(name) for name in list(model.names)[1:]]
    for _ in range(POSES):
        q, v = _pose(robot, rng)
        own = _configuration(model, q[order])
        upper = np.triu(pin.crba(model, data, own))
        inertia = upper + np.triu(upper, 1).T - np.diag(model.armature)
        ours = mass_matrix(nominal, q)[np.ix_(order, order)] - np.diag(robot.armature[order])
        terms = pin.nonLinearEffects(model, data, own, v[order])
        rows.append((_apart(ours, inertia), _apart(bias(nominal, q, v)[order], terms)))
    inertia, terms = np.max(rows, axis=0).tolist()
    return inertia, terms


def _configuration(model: Any, angles: np.ndarray[Any, Any]) -> Any:
    """Return a position as Pinocchio takes it, which holds a joint without end as its cosine and sine."""
    found = pin.neutral(model)
    for k, angle in enumerate(angles, start=1):
        first = model.joints[k].idx_q
        if model.joints[k].nq == 1:
            found[first] = angle
        else:
            found[first : first + 2] = np.cos(angle), np.sin(angle)
    return found


def _pose(robot: RobotDescription, rng: np.random.Generator) -> tuple[Any, Any]:
    """Return a random position (nq,) within the joints' ranges and a random velocity (nv,)."""
    low, high = np.array([joint.range for joint in robot.joints]).T
    angles = rng.uniform(np.maximum(low, -np.pi), np.minimum(high, np.pi))
    base = np.concatenate([rng.normal(size=3), _unit(rng.normal(size=4))]) if robot.floating else np.zeros(0)
    return np.concatenate([base, angles]), rng.uniform(-SPEED, SPEED, robot.layout.nv)


def _unit(vector: Any) -> Any:
    return vector / np.linalg.norm(vector)


def _apart(one: Any, other: Any) -> float:
    """Return the largest difference, a share of the largest entry."""
    return float(np.abs(one - other).max() / np.abs(other).max())


def run(options: Namespace) -> Iterator[str]:
    """Write a table as the command's options say, and yield what is printed."""
    out = options.out or Path(f"{options.file.stem}.yaml")
    if out.exists() and not options.force:
        raise ConfigError(f"{out}: exists already; accepted: another --out, or --force")
    taken = options.torque_limit, options.speed_limit, options.armature
    found = import_robot(options.file, check_base(options.base), *taken)
    text = table_text(found, options.file.name).encode()
    with atomic_path(out, len(text)) as temporary:  # what is refused leaves an older table as it is
        temporary.write_bytes(text)
        lines = list(told(_read(temporary, options.file), found, options.file))
    yield from lines
    yield f"written: {out}"


def _read(table: Path, source: Path) -> RobotDescription:
    """Return the robot of a table; what is not accepted in it is told of its source."""
    try:
        return describe(load_section(table, RobotTable))
    except ConfigError as error:
        raise ConfigError(str(error).replace(str(table), f"{source}, as a table")) from None


def main(words: list[str]) -> int:
    """Run the command; return its exit status."""
    options = import_parser().parse_args(words)
    return printed(log, lambda: run(options))


def told(robot: RobotDescription, found: Imported, path: Path) -> Iterator[str]:
    """Yield what the command prints."""
    kind = "floating" if robot.floating else "fixed"
    yield f"{robot.name}: {robot.layout.nu} joints, {len(robot.bodies)} bodies, {robot.mass:.6g} kg, {kind} base"
    yield from (f"limb {name}: {', '.join(joints)}" for name, joints in found.groups.items())
    yield from (f"note: {note}" for note in found.notes)
    for reading, inertia, terms in differences(robot, found, path):
        yield f"against {reading}'s own reading: mass matrix {inertia:.1e}, bias {terms:.1e} of their largest entries"


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
