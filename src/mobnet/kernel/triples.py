"""Vectors of three numbers in compiled code: tuples, which stay in registers, from and to lanes of (3, lanes)."""

from mobnet.core.arrays import Array
from mobnet.core.machine_code import compiled

Triple = tuple[float, float, float]


@compiled
def vector(array: Array) -> Triple:
    """Return the first three numbers of an array (3+,)."""
    return array[0], array[1], array[2]


@compiled
def at(array: Array, lane: int) -> Triple:
    """Return a lane of an array (3, lanes)."""
    return array[0, lane], array[1, lane], array[2, lane]


@compiled
def put(array: Array, lane: int, x: Triple) -> None:
    """Set a lane of an array (3, lanes)."""
    array[0, lane], array[1, lane], array[2, lane] = x[0], x[1], x[2]


@compiled
def add(x: Triple, y: Triple) -> Triple:
    """Return x + y."""
    return x[0] + y[0], x[1] + y[1], x[2] + y[2]


@compiled
def times(factor: float, x: Triple) -> Triple:
    """Return factor * x."""
    return factor * x[0], factor * x[1], factor * x[2]


@compiled
def dot(x: Triple, y: Triple) -> float:
    """Return x . y."""
    return x[0] * y[0] + x[1] * y[1] + x[2] * y[2]


@compiled
def cross(x: Triple, y: Triple) -> Triple:
    """Return x cross y."""
    return x[1] * y[2] - x[2] * y[1], x[2] * y[0] - x[0] * y[2], x[0] * y[1] - x[1] * y[0]


@compiled
def product(matrix: Array, x: Triple) -> Triple:
    """Return a matrix (3, 3) times x."""
    return dot(vector(matrix[0]), x), dot(vector(matrix[1]), x), dot(vector(matrix[2]), x)


@compiled
def out_of(rotation: Array, lane: int, x: Triple) -> Triple:
    """Return a lane of rotations (3, 3, lanes) times x: into the parent's axes."""
    return dot(at(rotation[0], lane), x), dot(at(rotation[1], lane), x), dot(at(rotation[2], lane), x)


@compiled
def into(rotation: Array, lane: int, x: Triple) -> Triple:
    """Return the transpose of a lane of rotations (3, 3, lanes) times x: out of the parent's axes."""
    first = times(x[0], at(rotation[0], lane))
    second = times(x[1], at(rotation[1], lane))
    return add(add(first, second), times(x[2], at(rotation[2], lane)))
