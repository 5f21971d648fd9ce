"""The ground below a robot on a picture: a round piece of floor with a grid, and the robot's shadow. Drawing only."""

from collections.abc import Iterable

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import LineCollection, PolyCollection
from matplotlib.patches import Polygon

from experiments.evaluation.figures.drawing.solids import Solid, ellipse_of, outline_of
from mobnet.core.arrays import Array

FLOOR, GRID, SHADOW = "#E9EDF2", "#D3D9E1", "#CBD1DA"
SUN = np.array([-0.3, 0.93, 0.2])  # towards the sun: right, up and towards the eye of a picture
GRID_M = 0.25  # between two lines of the floor


def draw_ground(axis: Axes, centre: Array, radius_m: float, view: Array) -> None:
    """Draw a round piece of the ground, z = 0, about a point (3,) [m], with lines that stay where they are."""
    middle = np.array([centre[0], centre[1], 0.0])
    floor = view[:2] @ middle + ellipse_of(radius_m * view[:2, :2])
    axis.add_patch(Polygon(floor, closed=True, facecolor=FLOOR, edgecolor=GRID, linewidth=0.8, zorder=0))
    ends = []
    for k in range(2):
        first, last = (np.ceil((middle[k] + sign * radius_m) / GRID_M) for sign in (-1, 1))
        for place in GRID_M * np.arange(first, last):
            reach = np.sqrt(max(radius_m**2 - (place - middle[k]) ** 2, 0.0))
            line = np.tile(middle, (2, 1))
            line[:, k], line[:, 1 - k] = place, middle[1 - k] + reach * np.array([-1.0, 1.0])
            ends.append(line @ view[:2].T)
    axis.add_collection(LineCollection(ends, colors=GRID, linewidths=0.7, zorder=0.1), autolim=False)


def draw_shadow(axis: Axes, solids: Iterable[Solid], view: Array) -> None:
    """Draw the shadow of solids on the ground, z = 0, in light from high above."""
    sun = view.T @ SUN
    falling = np.eye(3)
    falling[:, 2] -= sun / sun[2]  # from a point along the light down to the ground
    outlines = [outline_of(solid, view @ falling) for solid in solids]
    axis.add_collection(PolyCollection(outlines, facecolors=SHADOW, linewidths=0.0, zorder=0.2), autolim=False)
