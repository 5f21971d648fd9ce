"""Points on the solids of a robot's table, with the normal and the area of each.

A solid of revolution is rings around its axis, an ellipsoid is a stretched sphere, and a box is six faces.
"""

from collections.abc import Iterator, Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from mobnet.core.arrays import Array
from mobnet.formats.parts import ShapeRow

Piece = tuple[float, float, float, float]  # of an outline: radius and height [m], angle of its normal, length [m]


class Patch(NamedTuple):
    """Points (k, 3) [m] on a solid, its outward normals there (k, 3), and the area that each stands for (k,) [m^2]."""

    points: Array
    normals: Array
    area: Array

    def only(self, kept: NDArray[np.bool_]) -> "Patch":
        """Return some of the points."""
        return Patch(self.points[kept], self.normals[kept], self.area[kept])


def patch_of(shape: ShapeRow, spacing_m: float) -> Patch:
    """Return points on a whole solid, about so far apart [m], in the axes of its body."""
    if shape.type == "box":
        points = _box(np.array(shape.size), spacing_m)
    elif shape.type == "ellipsoid":
        points = _stretched(_revolved(_profile("sphere", 1.0, 0.0, spacing_m / (sum(shape.size) / 3.0))), shape.size)
    else:
        radius = shape.size[0]
        half = _half_length(shape)
        points = _revolved(_profile(shape.type, radius, half, spacing_m))
    centre, axes = placed(shape)
    return Patch(centre + points.points @ axes.T, points.normals @ axes.T, points.area)


def placed(shape: ShapeRow) -> tuple[Array, Array]:
    """Return the centre (3,) [m] of a solid in its body, and its axes (3, 3), the last one along its length."""
    if shape.segment is None:
        return np.array(shape.pos), np.eye(3)
    start, end = np.reshape(shape.segment, (2, 3))
    along = (end - start) / np.linalg.norm(end - start)
    first, second = across(along[None])
    return (start + end) / 2.0, np.column_stack([first[0], second[0], along])


def across(normals: Array) -> tuple[Array, Array]:
    """Return two unit vectors (k, 3) at right angles to unit vectors (k, 3) and to each other."""
    other = np.eye(3)[np.abs(normals).argmin(axis=1)]
    first: Array = np.cross(normals, other)
    first /= np.linalg.norm(first, axis=1, keepdims=True)
    second: Array = np.cross(normals, first)
    return first, second


def depth(shape: ShapeRow, points: Array) -> Array:
    """Return how deep points (k, 3) [m] of a body lie inside its solid (k,) [m], below zero outside.

    Of an ellipsoid it is the share of the way to its surface times its least half length.
    """
    centre, axes = placed(shape)
    local = (points - centre) @ axes
    if shape.type == "box":
        return (np.array(shape.size) - np.abs(local)).min(axis=1)
    if shape.type == "ellipsoid":
        return (1.0 - np.linalg.norm(local / np.array(shape.size), axis=1)) * min(shape.size)
    radius = shape.size[0]
    half = _half_length(shape)
    if shape.type == "cylinder":
        return np.minimum(radius - np.linalg.norm(local[:, :2], axis=1), half - np.abs(local[:, 2]))
    local[:, 2] -= np.clip(local[:, 2], -half, half)
    return radius - np.linalg.norm(local, axis=1)


def _half_length(shape: ShapeRow) -> float:
    """Return half the length of a solid of revolution between its ends [m], caps not counted."""
    if shape.segment is not None:
        start, end = np.reshape(shape.segment, (2, 3))
        return float(np.linalg.norm(end - start)) / 2.0
    return shape.size[1] if len(shape.size) > 1 else 0.0


def _profile(kind: str, radius: float, half: float, spacing_m: float) -> Iterator[Piece]:
    """Yield middles of pieces of the outline of a solid of revolution: radius, height [m], angle of normal, length [m].

    The angle [rad] is that above the plane across the axis.
    """
    if half > 0.0:
        count = max(1, round(2.0 * half / spacing_m))
        yield from ((radius, half * (2 * i + 1 - count) / count, 0.0, 2.0 * half / count) for i in range(count))
    rounded = kind != "cylinder"
    cap = max(1, round((np.pi / 2.0 if rounded else 1.0) * radius / spacing_m))
    for i in range(cap):
        share = (i + 0.5) / cap
        angle = share * np.pi / 2.0 if rounded else np.pi / 2.0
        place = radius * np.cos(angle) if rounded else radius * share
        height = half + (radius * np.sin(angle) if rounded else 0.0)
        length = (np.pi / 2.0 if rounded else 1.0) * radius / cap
        yield place, height, angle, length
        yield place, -height, -angle, length


def _revolved(profile: Iterator[Piece]) -> Patch:
    """Return the points of rings around the last axis; they are as far apart around a ring as along the outline."""
    points = []
    normals = []
    area = []
    for place, height, angle, length in profile:
        count = max(1, round(2.0 * np.pi * place / length))
        turns = 2.0 * np.pi * np.arange(count) / count
        flat = np.column_stack([np.cos(turns), np.sin(turns)])
        points.append(np.column_stack([place * flat, np.full(count, height)]))
        normals.append(np.column_stack([np.cos(angle) * flat, np.full(count, np.sin(angle))]))
        area.append(np.full(count, 2.0 * np.pi * place * length / count))
    return Patch(np.concatenate(points), np.concatenate(normals), np.concatenate(area))


def _stretched(sphere: Patch, half: Sequence[float]) -> Patch:
    """Return the unit sphere stretched to an ellipsoid of half lengths (3,) [m]."""
    normals = sphere.normals / np.array(half)
    size = np.linalg.norm(normals, axis=1)
    # an element of area grows by the determinant of the stretch times the length of the stretched normal
    return Patch(sphere.points * np.array(half), normals / size[:, None], sphere.area * np.prod(half) * size)


def _box(half: Array, spacing_m: float) -> Patch:
    """Return the points on the faces of a box of half lengths (3,) [m]."""
    counts = np.maximum(1, np.rint(2.0 * half / spacing_m)).astype(int)
    faces = []
    for axis in range(3):
        grids = [length * (2.0 * np.arange(n) + 1.0 - n) / n for length, n in zip(half, counts, strict=True)]
        grids[axis] = np.array([-half[axis], half[axis]])
        points = np.stack(np.meshgrid(*grids, indexing="ij"), axis=-1).reshape(-1, 3)
        normals = np.zeros(points.shape)
        normals[:, axis] = np.sign(points[:, axis])
        size = 8.0 * np.prod(half) / half[axis] / len(points)  # two faces
        faces.append(Patch(points, normals, np.full(len(points), size)))
    return Patch(*(np.concatenate(parts) for parts in zip(*faces, strict=True)))
