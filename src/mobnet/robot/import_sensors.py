"""What a robot's file tells of its inertial sensor and its feet, by names and places of its parts."""

import re
from collections.abc import Iterator, Mapping, Sequence
from typing import Any

import mujoco
import numpy as np

from mobnet.core.joints import right_of

INERTIAL = (mujoco.mjtSensor.mjSENS_ACCELEROMETER, mujoco.mjtSensor.mjSENS_GYRO)
NAMED = re.compile("imu|inertial", re.IGNORECASE)
BASE = 1  # the first body below the world
LEVEL_M = 0.02  # feet stand at one height, within this
TURN = 1e-6  # a smaller difference of axes is none


def sensors_of(model: mujoco.MjModel) -> tuple[dict[str, Any] | None, list[str]]:
    """Return the row of the inertial sensor on a floating base, None without one, and what else was found.

    The model has its welded bodies as they are in the file. A body or a site is taken for a sensor by its name; a site
    also if an accelerometer or a gyroscope is there.
    """
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    row, notes = None, list[str]()
    axes = data.xmat[BASE].reshape(3, 3)
    for name, body, place, turn in _places(model, data):
        carrier = model.body(model.body_weldid[body]).name
        if model.body_weldid[body] != BASE:
            notes.append(
                f"{name}: an inertial sensor on {carrier}; a table has that of the base, {model.body(BASE).name}"
            )
        elif row is not None:
            notes.append(f"{name}: another inertial sensor on the base; `imu` of the table is the first")
        else:
            row = {"body": carrier, "pos": (axes.T @ (place - data.xpos[BASE])).tolist()}
            if np.abs(axes.T @ turn.reshape(3, 3) - np.eye(3)).max() > TURN:
                notes.append(f"{name}: its axes are not those of the base; a log takes its readings in base axes")
    return row, notes


def _places(model: mujoco.MjModel, data: mujoco.MjData) -> Iterator[tuple[str, int, Any, Any]]:
    """Yield name, body, position (3,) [m] and axes (9,) of what looks like an inertial sensor."""
    sites = {int(model.sensor_objid[k]) for k in range(model.nsensor) if model.sensor_type[k] in INERTIAL}
    sites |= {k for k in range(model.nsite) if NAMED.search(model.site(k).name)}
    for k in sorted(sites):
        yield model.site(k).name, int(model.site_bodyid[k]), data.site_xpos[k], data.site_xmat[k]
    for k in range(BASE + 1, model.nbody):
        if NAMED.search(model.body(k).name):
            yield model.body(k).name, k, data.xpos[k], data.xmat[k]


def feet_of(
    model: mujoco.MjModel, limbs: Mapping[str, Sequence[str]], joints: Sequence[Mapping[str, Any]]
) -> Iterator[str]:
    """Yield the pair of bodies at the ends of limbs that are lowest while all joints are at zero: feet, most likely."""
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    moved = {joint["id"]: joint["body"] for joint in joints}
    ends = {moved[chain[-1]]: limb for limb, chain in limbs.items()}
    heights = {body: float(data.body(body).xpos[2]) for body in ends if _is_named(model, body)}
    lowest = min(heights.values(), default=0.0)
    feet = [body for body, height in heights.items() if height < lowest + LEVEL_M]
    pairs = [(body, right_of(body)) for body in feet if right_of(body) != body and right_of(body) in feet]
    for left, right in pairs:
        both = f"{{left: {{body: {left}, limb: {ends[left]}}}, right: {{body: {right}, limb: {ends[right]}}}}}"
        yield f"feet: these bodies at the ends of limbs are lowest: {both}; `sole` is to be added with them"


def _is_named(model: mujoco.MjModel, body: str) -> bool:
    """Return whether the file has a body of a name, which a table may have changed."""
    return mujoco.mj_name2id(model, mujoco.mjtObj.mjOBJ_BODY, body) >= 0
