"""Friction, rotor inertia and errors of the links by regularised least squares, with intervals.

All joints are fitted at once, as the error of a link acts on each joint that carries it. Friction and inertia are not
negative; an offset and the error of a scale have either sign. A log cannot tell a rotor from the link that it turns
where both turn about one axis alone. So the errors of the links have a prior: a description's masses and centres of
mass are right within a share and a distance. A link's mass and inertia change by one factor and its centre of mass
moves, so that it stays a rigid body (Traversaro et al., "Identification of fully physical consistent inertial
parameters using optimization on manifolds", IROS 2016, on why this matters).

The intervals have two parts. Errors that vary with the motion are alike for about a second, so that samples are not
independent, but windows are: the sandwich of their scores (Liang and Zeger, "Longitudinal data analysis using
generalized linear models", Biometrika 73(1), 1986). What the prior leaves open of the links adds its own variance.
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.optimize import lsq_linear
from scipy.stats import t

from mobnet.core.arrays import Array
from mobnet.robotlog.identifying.payload import NUMBERS, START, Payload, linearised, parameters, payload_of
from mobnet.robotlog.identifying.regressors import LINK, Columns, RegressorWindows, together

FREE = ("offset", "scale")  # of either sign: errors of a sensor, which dissipate nothing
DAHL = "breakaway"
OPEN = 1e3  # standard deviation of what has no prior, a payload's mass [kg] and first moment [kg m]
ROUNDS = 4  # of fitting all joints, and choosing the signs by what the links do not explain
LEAST = 1e-9  # root mean square below which a column did not vary, and the share that keeps a solution unique


@dataclass(frozen=True)
class FitNumbers:
    """How windows become the numbers of joints.

    Attributes:
        folds: parts of the windows, each of which is held out once to choose the smooth sign of a joint.
        gain: share by which Dahl's law must lower the error on the parts held out.
        mass_share: standard deviation of the share by which a link's mass and inertia differ from those of the table.
        com_m: the same of its centre of mass, along each axis [m].
        payload_kg_m3: density of a payload, which is taken for a ball [kg/m^3].
        confidence: nominal one of the intervals.
    """

    folds: int
    gain: float
    mass_share: float
    com_m: float
    payload_kg_m3: float
    confidence: float


@dataclass(frozen=True)
class JointFit:
    """The numbers of a joint.

    Attributes:
        sign: kind of the smooth sign, and its width [rad/s] or angle [rad].
        factors: term -> its number; `scale` is what is to be added to 1.
        half: term -> half the width of its interval.
        before_nm: root mean square of the residual on the time held out [N m], and
        after_nm: of what a fit to the other time leaves of it.
    """

    sign: tuple[str, float]
    factors: Mapping[str, float]
    half: Mapping[str, float]
    before_nm: float
    after_nm: float

    @property
    def explained(self) -> float:
        """Share of the residual's square that is explained on the time held out."""
        return 1.0 - (self.after_nm / self.before_nm) ** 2 if self.before_nm else 0.0


@dataclass(frozen=True)
class Problem:
    """What is solved: terms of each joint, its smooth sign (nu,), the weight of its errors (nu,) and the prior.

    `prior` (d,) is the standard deviation of the links' errors.
    """

    columns: Columns
    terms: tuple[str, ...]
    signs: tuple[int, ...]
    weights: Array
    prior: Array

    def own(self, windows: RegressorWindows, joint: int) -> Array:
        """Return the columns of a joint, (windows, rows, terms)."""
        return windows.joints[:, :, joint, [self.columns.of(term, self.signs[joint]) for term in self.terms]]


@dataclass(frozen=True)
class Solution:
    """Numbers of the joints (nu, terms), errors of the links (d,), and the matrix of the equations with the prior."""

    joints: Array
    links: Array
    matrix: Array


def fit_joints(
    known: RegressorWindows,
    held_out: RegressorWindows,
    columns: Columns,
    terms: Sequence[str],
    numbers: FitNumbers,
) -> tuple[list[JointFit], Payload | None]:
    """Fit all joints: what is not held out chooses the signs, and its fit is tried on what is held out.

    The numbers are those of all windows. Errors of the links are fitted to keep them right; the table does not get
    them, and so they do not count where the fit is tried.
    """
    problem, tried = solved(known, columns, terms, numbers)
    windows = together([known, held_out])
    density = numbers.payload_kg_m3
    loaded = known.payload.shape[-1] > 0
    carried = parameters(tried.links[-NUMBERS:], density) if loaded else np.zeros(0)
    windows = linearised(windows, tried.links[-NUMBERS:], density) if loaded else windows
    final = solution(windows, problem)
    halves = half_widths(windows, problem, final, numbers.confidence)
    half = halves[: final.joints.size].reshape(final.joints.shape)
    payload = payload_of(final.links[-NUMBERS:], halves[-NUMBERS:], density) if loaded else None
    unseen = held_out.joints[..., -1]
    fits = list[JointFit]()
    for j, sign in enumerate(problem.signs):
        rest = unseen[:, :, j] - problem.own(held_out, j) @ tried.joints[j]
        # A payload becomes a body of the table, so that it counts here; errors of the links do not get there.
        rest = rest - held_out.payload[:, :, j] @ carried
        factors, widths = (dict(zip(terms, numbers[j].tolist(), strict=True)) for numbers in (final.joints, half))
        fits.append(JointFit(columns.signs[sign], factors, widths, _rms(unseen[:, :, j]), _rms(rest)))
    return fits, payload


def solved(
    windows: RegressorWindows, columns: Columns, terms: Sequence[str], numbers: FitNumbers
) -> tuple[Problem, Solution]:
    """Return the signs of the joints, the weights of their errors, and the numbers with them."""
    nu = windows.joints.shape[2]
    prior = np.tile([numbers.mass_share, *(numbers.com_m,) * (len(LINK) - 1)], nu)
    # All torques times a factor are those of links and friction times that factor: a scale takes the links as they are.
    prior *= LEAST if "scale" in terms else 1.0
    loaded = windows.payload.shape[-1] > 0
    near = START
    prior = np.append(prior, np.full(NUMBERS, OPEN)) if loaded else prior
    by_links = np.zeros(windows.joints.shape[:3])
    given = windows
    problem = Problem(columns, tuple(terms), (0,) * nu, np.ones(nu), prior)
    solution_so_far = None
    for _ in range(ROUNDS):
        windows = linearised(given, near, numbers.payload_kg_m3) if loaded else given
        targets = windows.joints[..., -1] - by_links
        signs = [
            chosen_sign(windows.joints[:, :, j, :-1], targets[:, :, j], columns, terms, numbers) for j in range(nu)
        ]
        problem = replace(problem, signs=tuple(signs))
        problem = replace(problem, weights=_weights(windows, problem, by_links))
        solution_so_far = solution(windows, problem)
        by_links = windows.links @ solution_so_far.links
        near = solution_so_far.links[-NUMBERS:]
    assert solution_so_far is not None
    return problem, solution_so_far


def _weights(windows: RegressorWindows, problem: Problem, by_links: Array) -> Array:
    """Return one over the variance of what is left of each joint (nu,), in whole windows."""
    weights = np.empty(len(problem.signs))
    for j in range(len(weights)):
        columns = problem.own(windows, j)
        target = windows.joints[:, :, j, -1] - by_links[:, :, j]
        rest = target - columns @ joint_numbers(_products(columns, target).sum(axis=0), problem.terms)
        # Samples of a window are alike: the square of their sum is larger than the sum of their squares.
        alike = np.square(rest.sum(axis=1)).mean() / rest.shape[1]
        weights[j] = 1.0 / max(float(np.square(rest).mean()), float(alike), LEAST)
    return weights


def chosen_sign(joint: Array, target: Array, columns: Columns, terms: Sequence[str], numbers: FitNumbers) -> int:
    """Return the smooth sign with the least error on parts of the windows that are held out one after another.

    Columns of a joint are (windows, rows, m), its target is (windows, rows). Dahl's law, which has a state, must pay.
    """
    products = _products(joint, target)
    parts = np.array_split(products, numbers.folds)
    sums = [part.sum(axis=0) for part in parts]
    whole = np.sum(sums, axis=0)
    scores = list[float]()
    for sign, (kind, _) in enumerate(columns.signs):
        chosen = np.ix_(*[[*(columns.of(term, sign) for term in terms), -1]] * 2)
        left = 0.0
        for unseen in sums:
            rest = np.append(-joint_numbers((whole - unseen)[chosen], terms), 1.0)
            left += float(rest @ unseen[chosen] @ rest)
        scores.append(left / (1.0 - numbers.gain if kind == DAHL else 1.0) ** 2)
    return int(np.argmin(scores))


def _products(columns: Array, target: Array) -> Array:
    """Return the products of columns (windows, rows, n) and a target (windows, rows) in each window, target last."""
    table = np.concatenate([columns, target[..., None]], axis=2)
    return table.transpose(0, 2, 1) @ table


def joint_numbers(products: Array, terms: Sequence[str]) -> Array:
    """Return the numbers (terms,) of a joint alone by products of its columns, target last."""
    size = np.sqrt(np.maximum(np.diag(products)[:-1], LEAST))
    matrix = products[:-1, :-1] / np.outer(size, size) + LEAST * np.eye(len(terms))
    return _bounded(matrix, products[:-1, -1] / size, np.array([term in FREE for term in terms])) / size


def _bounded(matrix: Array, right: Array, free: Array) -> Array:
    """Return the least squares of equations, none below zero but the free ones."""
    root = np.linalg.cholesky(matrix).T
    target = np.linalg.solve(root.T, right)
    low = np.where(free, -np.inf, 0.0)
    numbers = np.asarray(np.linalg.solve(root, target), dtype=np.float64)
    return numbers if (numbers >= low).all() else lsq_linear(root, target, (low, np.inf), method="bvls").x


def solution(windows: RegressorWindows, problem: Problem) -> Solution:
    """Return the regularised least squares of all joints and links."""
    nu = len(problem.signs)
    count = len(problem.terms)
    d = len(problem.prior)
    matrix = np.zeros((nu * count + d,) * 2)
    right = np.zeros(nu * count + d)
    behind = slice(nu * count, None)
    matrix[behind, behind] = np.diag(problem.prior**-2)
    for j in range(nu):
        columns = problem.own(windows, j).reshape(-1, count)
        links = windows.links[:, :, j].reshape(-1, d)
        target = windows.joints[:, :, j, -1].ravel()
        weight = problem.weights[j]
        place = slice(j * count, (j + 1) * count)
        matrix[place, place] = weight * columns.T @ columns
        matrix[place, behind] = weight * columns.T @ links
        matrix[behind, place] = matrix[place, behind].T
        matrix[behind, behind] += weight * links.T @ links
        right[place] = weight * columns.T @ target
        right[behind] += weight * links.T @ target
    size = np.sqrt(np.maximum(np.diag(matrix), LEAST))
    own_free = [term in FREE for term in problem.terms]
    free = np.array([*own_free * nu, *[True] * d])
    # A log cannot tell all numbers apart; a small share of the diagonal keeps the solution unique.
    scaled = matrix / np.outer(size, size) + LEAST * np.eye(len(size))
    numbers = _bounded(scaled, right / size, free) / size
    return Solution(numbers[: nu * count].reshape(nu, count), numbers[nu * count :], matrix)


def half_widths(windows: RegressorWindows, problem: Problem, solution: Solution, confidence: float) -> Array:
    """Return half the widths of the intervals of the joints' numbers and of the links' errors, (nu * terms + d,)."""
    (nu, count) = solution.joints.shape
    d = len(problem.prior)
    groups = len(windows)
    # Errors that vary with the motion are alike for about a second: windows are independent, their samples are not.
    scores = np.zeros((groups, nu * count + d))
    for j in range(nu):
        columns = problem.own(windows, j)
        links = windows.links[:, :, j]
        rest = windows.joints[:, :, j, -1] - columns @ solution.joints[j] - links @ solution.links
        scores[:, j * count : (j + 1) * count] = problem.weights[j] * np.einsum("gr,grk->gk", rest, columns)
        scores[:, nu * count :] += problem.weights[j] * np.einsum("gr,grk->gk", rest, links)
    middle = groups / (groups - 1) * scores.T @ scores
    # What the prior leaves open of the links adds its own variance.
    middle[nu * count :, nu * count :] += np.diag(problem.prior**-2)
    size = np.sqrt(np.maximum(np.diag(solution.matrix), LEAST))
    scaled = solution.matrix / np.outer(size, size) + LEAST * np.eye(len(size))
    inverse = np.linalg.inv(scaled)
    variance = np.diag(inverse @ (middle / np.outer(size, size)) @ inverse) / size**2
    return float(t.ppf((1 + confidence) / 2, groups - 1)) * np.sqrt(variance)


def _rms(values: Array) -> float:
    """Return the root mean square of values."""
    return float(np.sqrt(np.square(values).mean()))
