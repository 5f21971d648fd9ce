"""A robot whose limbs have colours, with the axes of some joints, sensors and a push. Drawing only."""

from collections.abc import Iterable, Mapping
from dataclasses import replace

import numpy as np
from matplotlib.axes import Axes
from matplotlib.patches import FancyArrowPatch
from matplotlib.patheffects import withStroke

from experiments.evaluation.figures.drawing.robot import poses_of, solids_of
from experiments.evaluation.figures.drawing.solids import draw_solids
from mobnet.core.arrays import Array
from mobnet.robot.description import RobotDescription

LIMBS: Mapping[str, str] = {  # limb -> its colour, none that a method has
    "LL": "#6FB3E0",
    "RL": "#4A86BD",
    "W": "#A794C6",
    "LA": "#86C9A0",
    "RA": "#5DA27A",
    "V": "#E2B457",
    "N": "#B4BAC2",
}
LEFT_AS_IT_IS = ("joint", "rubber", "glass", "lamp", "dark")  # tones that no limb colours
AXIS_M = 0.15  # half length of the axis of a joint
NAME_M = 0.07  # from an arrow to its name
NAME_POINTS = 7.0  # size of the name of a joint
INK = "#1B1F24"
HALO = [withStroke(linewidth=2.2, foreground="white")]  # of lines: around text it would turn letters into outlines
GROUND = {"facecolor": "white", "alpha": 0.75, "edgecolor": "none", "pad": 0.4}  # behind the name of a joint


def limbs_of(robot: RobotDescription) -> dict[str, str]:
    """Return body -> limb whose joint moves it, or the body that it hangs on; of a free base the virtual one."""
    of_joint = robot.layout.limb_of
    limbs: dict[str, str] = {}
    for body in robot.bodies:
        joint = robot.joint_of(body.name)
        base = of_joint[robot.layout.virtual[0]] if robot.floating else ""
        limbs[body.name] = of_joint[joint.id] if joint else limbs.get(body.parent, base)
    return limbs


def draw_limbs(axis: Axes, robot: RobotDescription, q: Array, view: Array) -> None:
    """Draw a robot at a position q (nq,) [m, -, rad], each limb in its colour, into axes in metres."""
    limbs = limbs_of(robot)
    coloured = [
        solid if solid.shape.tone in LEFT_AS_IT_IS else replace(solid, colour=LIMBS[limbs[solid.shape.body]])
        for solid in solids_of(robot, q)
    ]
    draw_solids(axis, coloured, view)


def axes_of(robot: RobotDescription, q: Array, joints: Iterable[str]) -> dict[str, tuple[Array, Array]]:
    """Return joint -> a point of its axis and its direction (3,), world axes, at a position q (nq,) [m, -, rad]."""
    rotation, position = poses_of(robot, q)
    rows = {row.id: row for row in robot.joints}
    return {
        joint: (position[rows[joint].body], rotation[rows[joint].body] @ np.asarray(rows[joint].axis))
        for joint in joints
    }


def draw_axes(axis: Axes, places: Mapping[str, tuple[Array, Array]], view: Array) -> None:
    """Draw the axes of joints as arrows with their names, in black on white, into axes in metres."""
    for joint, (point, direction) in places.items():
        start, end = (view[:2] @ (point + sign * AXIS_M * direction) for sign in (-1.0, 1.0))
        arrow = FancyArrowPatch(
            tuple(start),
            tuple(end),
            arrowstyle="-|>,head_length=3,head_width=1.6",
            mutation_scale=1.0,
            shrinkA=0.0,
            shrinkB=0.0,
            color=INK,
            linewidth=0.9,
            zorder=5,
            path_effects=HALO,
        )
        axis.add_patch(arrow)
        x, y = end + NAME_M * (end - start) / np.linalg.norm(end - start)
        axis.text(x, y, joint, ha="center", va="center", fontsize=NAME_POINTS, zorder=8, bbox=GROUND)


def draw_note(axis: Axes, text: str, place: Array, at: tuple[float, float]) -> None:
    """Write a text at a place of the picture [m], with a thin line to what it names."""
    line = {"arrowstyle": "-", "color": "0.45", "linewidth": 0.5, "shrinkA": 1.0, "shrinkB": 0.0}
    x, y = place.tolist()
    axis.annotate(text, (x, y), at, ha="left", va="center", fontsize=7, arrowprops=line, zorder=7)
    axis.plot(x, y, marker="o", markersize=1.8, color="0.25", zorder=7)
