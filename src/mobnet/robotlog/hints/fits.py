"""Least squares of a joint's torque: what its motion needs beside friction, rotor inertia and a small offset.

No table has them in full, and without them a mistake that looks like friction would be taken for another one. Friction
and inertia take no torque away from what moves a joint, so that a torque of the wrong sign cannot hide in them.
"""

from functools import cache
from itertools import product

import numpy as np

from mobnet.core.arrays import Array

STEADY = 0.05  # speed at which dry friction has turned round [rad/s]
BLOCKS = 10  # of windows, each half of which is explained by what was fitted to the other half
SMALL = 1e-12  # share added to squares, so that a joint at rest has numbers, too
TINY = np.finfo(float).tiny


def quotient(part: Array, whole: Array) -> Array:
    """Return part / whole, whole not below zero; beside a whole as good as nothing it ends at a size of 1 / SMALL.

    A joint whose torque is zero in a log, or whose unit is far off, would leave the range of numbers otherwise.
    """
    return part / np.maximum(np.maximum(whole, SMALL * np.abs(part)), TINY)


def dissipation(speed: Array, change: Array) -> Array:
    """Return what dry friction, viscous friction and rotor inertia multiply, (..., 3).

    `speed` [rad/s] and `change`, its derivative [rad/s^2], are (...).
    """
    terms = np.empty((*speed.shape, 3))
    terms[..., 0] = dry(speed)
    terms[..., 1] = speed
    terms[..., 2] = change
    return terms


def dry(speed: Array) -> Array:
    """Return the smooth sign of speeds [rad/s], which dry friction multiplies."""
    return np.tanh(speed / STEADY)


def positive_fit(terms: Array, targets: Array) -> Array:
    """Return the numbers (..., p, m) of least squares, none below zero, by which terms (..., W, p) make up targets.

    Targets are (..., W, m). Of few terms all choices of those above zero can be tried: the best of those whose numbers
    are all above zero is the answer.
    """
    count = terms.shape[-1]
    across = np.swapaxes(terms, -1, -2)
    gram = across @ terms
    cross = across @ targets
    # A joint at rest, whose terms are zero, gets numbers, too.
    gram += (SMALL * gram.max(axis=(-1, -2), keepdims=True) + TINY) * np.eye(count)
    chosen, both, others = _choices(count)
    normal_matrix = gram[..., None, :, :] * both + others
    wanted = cross[..., None, :, :] * chosen[:, :, None]
    numbers = np.linalg.solve(normal_matrix, wanted)  # (..., choices, p, m), zero where not chosen
    explained = np.where((numbers >= 0.0).all(axis=-2), (numbers * wanted).sum(axis=-2), -np.inf)
    best = explained.argmax(axis=-2)[..., None, None, :]
    return np.take_along_axis(numbers, best, axis=-3)[..., 0, :, :]


@cache
def _choices(count: int) -> tuple[Array, Array, Array]:
    """Return all choices among so many terms (c, p), the pairs in each, and ones for the others (c, p, p)."""
    chosen = np.array(list(product((0.0, 1.0), repeat=count)))
    return chosen, chosen[:, :, None] * chosen[:, None, :], (1 - chosen)[:, :, None] * np.eye(count)


def friction_fit(terms: Array, rest: Array, offset: Array) -> tuple[Array, Array]:
    """Return the numbers (..., p, m) of terms (..., W, p) that make up what is left of torques, and its offsets.

    What is left is (..., W, m) [N m], offsets are (..., 1, m) and at most so large (...,) [N m].
    """
    middle = terms.mean(axis=-2, keepdims=True)
    means = rest.mean(axis=-2, keepdims=True)
    numbers = positive_fit(terms - middle, rest - means)
    most = np.asarray(offset)[..., None, None]
    constant = np.clip(means - middle @ numbers, -most, most)
    return positive_fit(terms, rest - constant), constant


def unexplained(terms: Array, needed: Array, torque: Array, offset: Array) -> Array:
    """Return the share of the square of measured torques that neither motion nor friction explains (..., m).

    Terms are (..., W, p), torques that the motion needs and that were measured (..., W, m) [N m], of which one may have
    a single column. What is fitted to one half of the windows must explain the other one.
    """
    rest = torque - needed
    count = rest.shape[-2]
    if count < BLOCKS:  # too few to try on some what was fitted to others
        return np.ones((*rest.shape[:-2], rest.shape[-1]))
    is_late = (np.arange(count) * BLOCKS // count) % 2 == 1
    early = np.flatnonzero(~is_late)
    late = np.flatnonzero(is_late)
    if len(early) == len(late):  # both at once: most of the time is that of calls
        pairs = [(np.stack([early, late]), np.stack([late, early]))]
    else:
        pairs = [(fitted[None], tried[None]) for fitted, tried in ((early, late), (late, early))]
    left = np.zeros((*rest.shape[:-2], rest.shape[-1]))
    for fitted, tried in pairs:
        numbers, constant = friction_fit(terms[..., fitted, :], rest[..., fitted, :], np.asarray(offset)[..., None])
        error = rest[..., tried, :] - terms[..., tried, :] @ numbers - constant
        left += np.square(error).sum(axis=-2).sum(axis=-2)
    return quotient(left, np.square(torque).sum(axis=-2))
