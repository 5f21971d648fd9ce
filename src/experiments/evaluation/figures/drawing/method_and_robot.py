"""Two drawings of what no run measures: the method as blocks, and the robot with its limbs and what it senses."""

from collections.abc import Mapping
from pathlib import Path

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from experiments.evaluation.figures.drawing.diagram import SUM_RADIUS, Box, draw_box, draw_path, draw_sum, sheet
from experiments.evaluation.figures.drawing.ground import draw_ground, draw_shadow
from experiments.evaluation.figures.drawing.pushed import draw_force, standing
from experiments.evaluation.figures.drawing.robot import point_at, poses_of, projection, solids_of
from experiments.evaluation.figures.drawing.robot_parts import LIMBS, axes_of, draw_axes, draw_limbs, draw_note
from experiments.evaluation.figures.style import save_figure
from experiments.settings.pages import Drawings
from mobnet.core.arrays import Array
from mobnet.core.joints import JointLayout
from mobnet.core.style import COLUMN_INCH, PAGE_INCH, styled
from mobnet.formats.parts import Looks
from mobnet.formats.robot import RobotTable
from mobnet.robot.description import RobotDescription, describe, dressed
from mobnet.settings.data import Push

METHOD_COLUMNS = ("from", "to", "signal")
ROBOT_COLUMNS = ("part", "kind", "x_m", "y_m", "z_m")
SIGMA = "\N{GREEK SMALL LETTER SIGMA}"
METHOD_INCH, ROBOT_INCH = 2.1, 2.4  # heights
SIZE_M = 0.2  # from the arrow's end to the middle of the force's size, in this small a picture
SENSED, MODEL, LEARNED, USED = "#EEF1F5", "#DCEAF6", "#FBE6D8", "#E3F1EA"  # grounds of blocks


@styled
def draw_all(
    settings: Drawings, push: Push, robot: RobotTable, looks: Looks | None, layout: JointLayout, folder: Path
) -> None:
    """Write `method` and `robot` as PDF, SVG, PNG and CSV: the blocks and their signals, the parts and their places."""
    figure, signals = draw_method([limb for limb in LIMBS if limb in settings.limbs])
    save_figure(figure, folder / "method", METHOD_COLUMNS, signals)
    shown = dressed(describe(robot), looks)
    figure, parts = draw_parts(settings, shown, position_of(settings, robot, layout), push)
    rows = [(name, kind, *map(float, place)) for name, kind, place in parts]
    save_figure(figure, folder / "robot", ROBOT_COLUMNS, rows)


def draw_method(limbs: list[str]) -> tuple[Figure, list[tuple[str, str, str]]]:
    """Draw the method as blocks; return the figure and from, to and signal of each arrow."""
    figure, axis = sheet(PAGE_INCH, METHOD_INCH)
    inputs = {
        "encoders": Box((0.62, 1.83), (1.1, 0.36), ["encoders", "joint positions"], SENSED),
        "IMU": Box((0.62, 1.37), (1.1, 0.36), ["IMU", "motion of the base"], SENSED),
        "motors": Box((0.62, 0.91), (1.1, 0.36), ["motors", "torque"], SENSED),
    }
    feet = Box((0.62, 0.27), (1.1, 0.36), ["foot sensors", "in training only"], SENSED, dashed=True)
    formula = Box((2.4, 1.88), (1.4, 0.36), ["friction formula", "in MOB-Net-gray only"], MODEL, dashed=True)
    observer = Box((2.4, 1.3), (1.4, 0.5), ["momentum observer", "external torque", "+ error of its model"], MODEL)
    network = Box((2.4, 0.48), (1.4, 0.82), ["one GRU for each limb", "error of the model", "", ""], LEARNED)
    torque = Box((5.25, 1.3), (1.05, 0.5), ["external torque", "of every joint", f"with its {SIGMA}"], USED)
    detector = Box((6.42, 1.3), (0.9, 0.36), ["detector", "thresholds"], USED)
    reaction = Box((6.42, 0.48), (0.9, 0.36), ["reaction", "steps back"], USED)
    for box in (*inputs.values(), feet, formula, observer, network, torque, detector, reaction):
        draw_box(axis, box)
    for k, limb in enumerate(limbs):
        place = network.centre[0] + (k - (len(limbs) - 1) / 2) * 0.215, network.centre[1] - 0.2
        draw_box(axis, Box(place, (0.18, 0.17), [limb], LIMBS[limb]))
    return figure, _arrows(axis, inputs, feet, formula, observer, network, torque, detector, reaction)


def _arrows(
    axis: Axes,
    inputs: Mapping[str, Box],
    feet: Box,
    formula: Box,
    observer: Box,
    network: Box,
    torque: Box,
    detector: Box,
    reaction: Box,
) -> list[tuple[str, str, str]]:
    """Draw the arrows between the blocks; return from, to and signal of each."""
    bus_x = 1.36
    y = observer.centre[1]
    first = (3.72, y)
    second = (4.4, y)
    draw_sum(axis, first, [("+", -0.14, -0.09), ("\N{MINUS SIGN}", 0.09, 0.14)])
    draw_sum(axis, second, [("+", -0.14, 0.09), ("\N{MINUS SIGN}", 0.09, -0.14)])
    for box in inputs.values():
        draw_path(axis, [box.side(1, 0), (bus_x, box.centre[1])], headed=False)
    low = network.centre[1] + 0.15
    high = formula.centre[1]
    draw_path(axis, [(bus_x, low), (bus_x, inputs["encoders"].centre[1])], headed=False)
    draw_path(axis, [(bus_x, inputs["encoders"].centre[1]), (bus_x, high), formula.side(-1, 0)], dashed=True)
    draw_path(axis, [(bus_x, y), observer.side(-1, 0)])
    draw_path(axis, [(bus_x, low), (network.side(-1, 0)[0], low)])
    draw_path(axis, [feet.side(1, 0), (network.side(-1, 0)[0], feet.centre[1])], dashed=True)
    draw_path(axis, [observer.side(1, 0), (first[0] - SUM_RADIUS, y)], "residual", (3.37, y + 0.1))
    draw_path(
        axis,
        [formula.side(1, 0), (first[0], high), (first[0], y + SUM_RADIUS)],
        "friction",
        (3.41, high + 0.1),
        dashed=True,
    )
    draw_path(axis, [(first[0] + SUM_RADIUS, y), (second[0] - SUM_RADIUS, y)])
    mean_y = network.centre[1] + 0.17
    sigma_y = network.centre[1] - 0.2
    right = network.side(1, 0)[0]
    draw_path(axis, [(right, mean_y), (second[0], mean_y), (second[0], y - SUM_RADIUS)], "mean", (3.75, mean_y + 0.1))
    draw_path(
        axis,
        [(right, sigma_y), (torque.centre[0], sigma_y), torque.side(0, -1)],
        f"standard deviation {SIGMA}",
        (4.17, sigma_y + 0.1),
    )
    draw_path(axis, [(second[0] + SUM_RADIUS, y), torque.side(-1, 0)])
    draw_path(axis, [torque.side(1, 0), detector.side(-1, 0)])
    draw_path(axis, [detector.side(0, -1), reaction.side(0, 1)], "alarm, link", (6.37, 0.89), ha="right")
    sensed = [(name, to, "sensed") for name in inputs for to in ("momentum observer", "networks", "friction formula")]
    return [
        *sensed,
        ("foot sensors", "networks", "label of the training"),
        ("momentum observer", "difference", "residual"),
        ("friction formula", "difference", "friction"),
        ("networks", "difference", "mean"),
        ("networks", "external torque", "standard deviation"),
        ("difference", "external torque", "estimate"),
        ("external torque", "detector", "estimate"),
        ("detector", "reaction", "alarm, link"),
    ]


def position_of(settings: Drawings, robot: RobotTable, layout: JointLayout) -> Array:
    """Return a position (nq,) [m, -, rad]: the posture, with the angles of the drawing, above the origin."""
    angles = {**robot.posture_rad, **settings.pose_rad}
    base = [0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0] if layout.virtual else []
    return np.array([*base, *(angles.get(joint, 0.0) for joint in layout.actuated)])


def draw_parts(
    settings: Drawings, robot: RobotDescription, q: Array, push: Push
) -> tuple[Figure, list[tuple[str, str, Array]]]:
    """Draw the robot with names; return the figure, and name, kind and place (3,) [m] of what is named."""
    figure, axis = sheet(COLUMN_INCH, ROBOT_INCH)
    view = projection(*settings.view_deg)
    placed = standing(robot, q)
    centre = np.array([*placed[:2], 0.0])
    solids = solids_of(robot, placed)
    draw_ground(axis, centre, settings.floor_m, view)
    draw_shadow(axis, solids, view)
    draw_limbs(axis, robot, placed, view)
    axes = axes_of(robot, placed, robot.layout.limb(settings.leg))
    draw_axes(axis, axes, view)
    point = point_at(robot, placed, str(push.point))
    draw_force(axis, point, np.array([-settings.force_n, 0.0, 0.0]), view, SIZE_M)
    rotation, position = poses_of(robot, placed)
    parts = [(joint, "axis", place) for joint, (place, _) in axes.items()]
    parts += [("push", "force", point)]
    for note in settings.notes:
        place = position[note.body] + rotation[note.body] @ np.asarray(note.pos)
        draw_note(axis, note.text, view[:2] @ place, note.at_m)
        parts.append((note.text, "note", place))
    (left, lower) = settings.corner_m
    scale = settings.m_per_inch
    axis.set(xlim=(left, left + scale * COLUMN_INCH), ylim=(lower, lower + scale * ROBOT_INCH))
    return figure, parts
