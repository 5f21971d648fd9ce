"""Capsules, cylinders, boxes, ellipsoids and spheres on a picture, seen from afar and lit from the upper left.

The outline of a round solid is exact: a ball's or a ring's ellipse, moved along the segment (its Minkowski sum). Shade
comes in steps: nested outlines, each smaller, brighter and nearer to the light than the one around it.
"""

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np
from matplotlib.axes import Axes
from matplotlib.collections import PolyCollection
from matplotlib.colors import to_rgb

from mobnet.core.arrays import Array
from mobnet.detection.solids import across
from mobnet.formats.parts import ShapeRow

LIGHT = np.array([-0.5, 0.65, 0.57])  # towards the light: right, up and towards the eye of a picture
AMBIENT, DIFFUSE = 0.62, 0.46  # brightness of a flat face without light, and what light adds at most
STEPS = ((1.0, 0.70), (0.9, 0.80), (0.74, 0.90), (0.54, 0.98), (0.3, 1.06))  # size and brightness of nested outlines
TOWARDS_LIGHT = 0.75  # of the way that a smaller outline may move within the one around it
CORNERS = 28  # of a round outline
EDGE, EDGE_POINTS, SEAM_POINTS = 0.42, 0.35, 0.2  # brightness and width [points] of lines around and in a solid
FLAT = 1e-4  # least half width of an ellipse, beside the size of a solid
CUBE = np.array(np.meshgrid(*[(-1.0, 1.0)] * 3)).reshape(3, -1).T  # corners (8, 3)
FACES = tuple((axis, sign) for axis in range(3) for sign in (-1.0, 1.0))


class Polygon(NamedTuple):
    """A part of a solid on the picture: corners (n, 2) [m], colours of face and line (3,), and its width [points]."""

    corners: Array
    colour: Array
    line: Array
    width: float


@dataclass(frozen=True)
class Solid:
    """A shape in the world.

    Attributes:
        shape: its row, in the axes of its body.
        rotation: orientation of the body (3, 3).
        position: origin of the body (3,) [m].
        colour: in Matplotlib's terms.
        opacity: of its faces; 1 hides what is behind.
    """

    shape: ShapeRow
    rotation: Array
    position: Array
    colour: Any
    opacity: float = 1.0

    @cached_property
    def ends(self) -> Array:
        """The two ends of its segment (2, 3) [m], which are one point for a solid at a point."""
        row = self.shape
        if row.segment is not None:
            ends = np.reshape(row.segment, (2, 3))
        elif row.type in ("capsule", "cylinder"):
            ends = np.asarray(row.pos) + np.outer([-1.0, 1.0], [0.0, 0.0, row.size[1]])
        else:
            ends = np.tile(row.pos, (2, 1))
        return ends @ self.rotation.T + self.position

    @cached_property
    def axes(self) -> Array:
        """Half axes of the ellipsoid or box at its ends, columns (3, 3) [m]; those of a cylinder span a ring (3, 2)."""
        size = self.shape.size
        if self.shape.type == "cylinder":
            start, end = self.ends
            along = (end - start) / np.linalg.norm(end - start)
            return size[0] * np.concatenate(across(along[None])).T
        return self.rotation * (np.asarray(size) if len(size) == 3 else size[0])

    @property
    def lowest(self) -> float:
        """The height of its lowest point [m]."""
        down = self.axes[2]
        reach = np.abs(down).sum() if self.shape.type == "box" else np.linalg.norm(down)
        return float(self.ends[:, 2].min() - reach)


def draw_solids(axis: Axes, solids: Iterable[Solid], view: Array, zorder: float = 2.0) -> None:
    """Draw solids into axes in metres, the farther ones first; the view (3, 3) is that of `projection`."""
    by_depth = sorted(solids, key=lambda solid: float((solid.ends @ view[2]).mean()))
    polygons: list[Polygon] = []
    faces: list[tuple[float, ...]] = []
    for solid in by_depth:
        seen = list(polygons_of(solid, view))
        polygons += seen
        faces += [(*polygon.colour, solid.opacity) for polygon in seen]
    corners, _, lines, widths = zip(*polygons, strict=True)
    drawn = PolyCollection(corners, facecolors=faces, edgecolors=lines, linewidths=widths, zorder=zorder)
    axis.add_collection(drawn, autolim=False)
    axis.set_aspect("equal")
    axis.set_axis_off()


def polygons_of(solid: Solid, view: Array) -> Iterator[Polygon]:
    """Yield the parts of a solid on a picture, in the order in which they are drawn."""
    colour = np.array(to_rgb(solid.colour))
    if solid.shape.type == "box":
        yield from _faces(solid, view, colour)
        return
    outer = EDGE * colour
    (sizes, brightness) = zip(*STEPS, strict=True)
    for k, outline in enumerate(outlines_of(solid, view, sizes)):
        shade = lit(colour, brightness[k])
        yield Polygon(outline, shade, shade if k else outer, 0.0 if k else EDGE_POINTS)
    if solid.shape.type == "cylinder":
        start, end = solid.ends if solid.ends[0] @ view[2] < solid.ends[1] @ view[2] else solid.ends[::-1]
        normal = view @ (end - start) / np.linalg.norm(end - start)
        yield Polygon(
            ellipse_of(view[:2] @ solid.axes) + view[:2] @ end, lit(colour, _flat(normal)), outer, SEAM_POINTS
        )


def outline_of(solid: Solid, view: Array) -> Array:
    """Return the outline of a solid on a picture (n, 2) [m]."""
    if solid.shape.type == "box":
        return hull_of((solid.ends[0] + CUBE @ solid.axes.T) @ view[:2].T)
    return outlines_of(solid, view, [1.0])[0]


def outlines_of(solid: Solid, view: Array, sizes: Sequence[float]) -> list[Array]:
    """Return outlines of a round solid on a picture (n, 2) [m]; a smaller one is nearer to the light within it."""
    axes = view @ solid.axes
    (start, end) = solid.ends @ view[:2].T
    facing = axes.T @ LIGHT
    moved = TOWARDS_LIGHT * axes[:2] @ facing / max(float(np.linalg.norm(facing)), FLAT)
    ring = ellipse_of(axes[:2])
    along = end - start
    outwards = (np.roll(ring, -1, axis=0) - np.roll(ring, 1, axis=0)) @ [[0.0, -1.0], [1.0, 0.0]] @ along > 0.0
    ends = np.where(outwards[:, None], end, start)
    return [size * ring + (1.0 - size) * moved + ends for size in sizes]


def hull_of(points: Array) -> Array:
    """Return the corners of the convex hull of points (n, 2) in order (k, 2)."""
    from scipy.spatial import ConvexHull  # here, as it takes a second to import

    return points[ConvexHull(points).vertices]


def ellipse_of(axes: Array) -> Array:
    """Return the outline, counter-clockwise (n, 2), of the image of a unit ball or ring under a matrix (2, k)."""
    squared = axes @ axes.T
    least = FLAT * np.sqrt(np.trace(squared))
    half = np.linalg.cholesky(squared + least**2 * np.eye(2))
    angle = np.linspace(0.0, 2 * np.pi, CORNERS, endpoint=False)
    return np.stack([np.cos(angle), np.sin(angle)], axis=1) @ half.T


def lit(colour: Array, brightness: float) -> Array:
    """Return a colour (3,) at a brightness; what is above 1 goes towards white."""
    return np.asarray(np.clip(colour * min(brightness, 1.0) + max(brightness - 1.0, 0.0) * 2.0, 0.0, 1.0))


def _flat(normal: Array) -> float:
    """Return the brightness of a flat face, by its normal on the picture (3,)."""
    return AMBIENT + DIFFUSE * max(0.0, float(normal @ LIGHT))


def _faces(solid: Solid, view: Array, colour: Array) -> Iterator[Polygon]:
    """Yield the faces of a box that are seen."""
    centre = view @ solid.ends[0]
    axes = view @ solid.axes
    for k, sign in FACES:
        normal = sign * axes[:, k] / np.linalg.norm(axes[:, k])
        if normal[2] > 0.0:
            first, other = (axes[:2, (k + step) % 3] for step in (1, 2))
            middle = centre[:2] + sign * axes[:2, k]
            corners = np.array([middle + a * first + b * other for a, b in ((1, 1), (-1, 1), (-1, -1), (1, -1))])
            yield Polygon(corners, lit(colour, _flat(normal)), EDGE * colour, EDGE_POINTS)
