"""A joint's numbers by least squares on products of its columns, with intervals, and how well they predict new time.

Friction and rotor inertia are not negative; an offset and the error of a scale have either sign. The smooth sign of a
joint is the one with the least error on parts of the time that are held out.

Errors of a model are alike for about a second, so that samples are not independent. Windows are, and the intervals are
those of the jackknife that leaves one window out at a time (Künsch, "The jackknife and the bootstrap for general
stationary observations", Annals of Statistics 17(3), 1989).
"""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from scipy.stats import t

from mobnet.core.arrays import Array
from mobnet.estimation.regression import non_negative
from mobnet.robotlog.identifying.regressors import PLAIN, Columns
from mobnet.settings.identification import Identification

FREE = ("offset", "scale")  # of either sign: errors of a sensor, which dissipate nothing
DAHL = "breakaway"


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


def fit_joint(
    known: Array, held_out: Array, columns: Columns, terms: Sequence[str], settings: Identification
) -> JointFit:
    """Fit a joint to mean products of windows, (windows, m, m) each: what is not held out chooses the sign.

    The numbers are those of all windows; the error on those held out is of numbers that do not know them.
    """
    sign = chosen_sign(known, columns, terms, settings)
    mixed = columns_by_term(sign, columns, terms)
    tried = solved(known.mean(axis=0), mixed)
    unseen = held_out.mean(axis=0)
    windows = np.concatenate([known, held_out])
    factors = solved(windows.mean(axis=0), mixed)
    return JointFit(
        columns.signs[sign], factors, half_widths(windows, mixed, settings.confidence),
        float(np.sqrt(unseen[-1, -1])), error(unseen, mixed, tried),
    )  # fmt: skip


def chosen_sign(windows: Array, columns: Columns, terms: Sequence[str], settings: Identification) -> int:
    """Return the smooth sign with the least error on parts of the windows that are held out one after another.

    Dahl's law, which has a state, must pay.
    """
    parts = np.array_split(np.arange(len(windows)), settings.folds)
    whole = windows.sum(axis=0)
    rest = [(whole - windows[part].sum(axis=0), windows[part].sum(axis=0)) for part in parts]
    scores = list[float]()
    for sign, (kind, _) in enumerate(columns.signs):
        mixed = columns_by_term(sign, columns, terms)
        left = [error(own, mixed, solved(others, mixed)) for others, own in rest]
        scores.append(float(np.linalg.norm(left)) / (1.0 - settings.gain if kind == DAHL else 1.0))
    return int(np.argmin(scores))


def columns_by_term(sign: int, columns: Columns, terms: Sequence[str]) -> dict[str, Array]:
    """Return term -> the column (m,) that it takes of those of a joint, whose smooth sign is one of those tried."""
    unit, count = np.eye(len(columns.names)), len(columns.signs)
    plain = dict(zip(PLAIN, unit[2 * count : -1], strict=True))
    dry = {"coulomb": unit[sign], "load": unit[count + sign]}
    return {term: {**dry, **plain}[term] for term in terms}


def solved(products: Array, mixed: Mapping[str, Array]) -> dict[str, float]:
    """Return the factors of the terms by mean products (m, m)."""
    return non_negative(products, mixed, [term for term in mixed if term in FREE])[0]


def error(products: Array, mixed: Mapping[str, Array], factors: Mapping[str, float]) -> float:
    """Return the root mean square of what factors leave of the target [N m], by mean products (m, m)."""
    rest = np.eye(len(products))[-1] - sum(factors[term] * column for term, column in mixed.items())
    return float(np.sqrt(max(0.0, rest @ products @ rest)))


def half_widths(windows: Array, mixed: Mapping[str, Array], confidence: float) -> dict[str, float]:
    """Return half the widths of the intervals of the factors, by leaving out one window (m, m) at a time."""
    count, whole = len(windows), windows.sum(axis=0)
    without = [list(solved((whole - window) / (count - 1), mixed).values()) for window in windows]
    spread = np.sqrt((count - 1) * np.var(without, axis=0))
    quantile = float(t.ppf((1 + confidence) / 2, count - 1))
    return dict(zip(mixed, (quantile * spread).tolist(), strict=True))
