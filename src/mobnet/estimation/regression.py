"""Regression of the friction model of (23) on r - tau_e, joint by joint, one recording at a time.

Linear in all but the Stribeck velocity: sums of products of all columns, for every Stribeck velocity of a grid, are
gathered in one pass; then each joint takes the grid's velocity that leaves the smallest error (docs/notes/0015).
"""

from __future__ import annotations

import logging
from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.optimize import nnls

from mobnet.core.config import load_layout
from mobnet.core.errors import DataError
from mobnet.core.methods import method_row, network_row
from mobnet.core.store import read_array
from mobnet.estimation.observer import low_pass

Array = NDArray[np.float64]
Pair = tuple[Path, Path]  # stems of a recording and of its residual
TERMS = {"coulomb": "coulomb_nm", "static": "static_nm", "viscous": "viscous_nms", "load": "load_per_nm"}
SIGN, VISCOUS, LOAD, STATIC = range(4)  # columns; one of `static` for each Stribeck velocity, then the target
log = logging.getLogger(__name__)


def fit(config: Mapping[str, Any], method: str, training: Mapping[str, Sequence[Pair]]) -> dict[str, Any]:
    """Regress the friction of a method's joints.

    Args:
        config: resolved configuration.
        method: row of its methods: `terms`, `smoothing_rad_s` and the grid `stribeck_rad_s`.
        training: limb -> stems of the recordings and residuals of its training set.

    Returns:
        `smoothing_rad_s`, and `joints`: name -> factors of (23), units in the keys, and the root mean square of the
        target and of what is left of it [N m].

    Raises:
        DataError: a recording is damaged.
    """
    row, layout = method_row(config, method), load_layout(Path(config["robot"]))
    joints: dict[str, Any] = {}
    for limb, pairs in training.items():
        names = [joint for group in network_row(config, method, limb)["joints"] for joint in layout.limb(group)]
        sums = _sums(config, row, [name for name in names if name in layout.actuated], pairs)
        loaded = {joint for group in config["networks"][limb]["T"] for joint in layout.limb(group)}
        for joint, products in sums.items():
            terms = [term for term in TERMS if term in row["terms"] and (term != "load" or joint in loaded)]
            joints[joint] = _solve(products, terms, row["stribeck_rad_s"])
            log.info("%s: %.2f of %.2f N m left", joint, joints[joint]["left_rms_nm"], joints[joint]["target_rms_nm"])
    ordered = {joint: joints[joint] for joint in layout.actuated if joint in joints}
    return {"smoothing_rad_s": row["smoothing_rad_s"], "joints": ordered}


def regressors(
    velocity: NDArray[Any], torque: NDArray[Any], smoothing: float, stribeck: float | Array
) -> dict[str, Array]:
    """Return term -> what its factor multiplies in -tau_f of (23).

    Args:
        velocity: joint velocity (..., n) [rad/s].
        torque: motor torque (..., n) [N m].
        smoothing: width of the sign function [rad/s].
        stribeck: v_s of (23), one or (n,) [rad/s].
    """
    sign, fade = np.tanh(velocity / smoothing), np.exp(-np.abs(velocity) / stribeck)
    return {"coulomb": sign * (1 - fade), "static": sign * fade, "viscous": velocity, "load": sign * torque**2}


def _sums(
    config: Mapping[str, Any], row: Mapping[str, Any], joints: Sequence[str], pairs: Sequence[Pair]
) -> dict[str, Array]:
    """Return joint -> mean products (m, m) of the columns of `_columns` over all recordings."""
    gain_hz, m = config["observer"]["gain_hz"], STATIC + len(row["stribeck_rad_s"]) + 1
    sums, count = {joint: np.zeros((m, m)) for joint in joints}, 0
    for recording_stem, residual_stem in pairs:
        velocity, torque, meta = _halves(recording_stem, ("v", "tau_motor"), joints)
        residual, external, _ = _halves(residual_stem, ("r", "tau_ext_lp"), joints)
        if len(residual) != len(velocity):
            raise DataError(f"{residual_stem}.parquet: {len(residual)} rows, but its recording has {len(velocity)}")
        for span in (slice(start, end) for start, end in meta["segments"]):
            for i, joint in enumerate(joints):
                columns = low_pass(_columns(row, velocity[span, i], torque[span, i]), gain_hz, meta["rate_hz"])
                columns = np.column_stack([columns, external[span, i] - residual[span, i]])
                sums[joint] += columns.T @ columns
            count += span.stop - span.start
        log.info("%s: %d joints", recording_stem, len(joints))
    return {joint: products / max(1, count) for joint, products in sums.items()}


def _halves(stem: Path, signals: tuple[str, str], joints: Sequence[str]) -> tuple[Array, Array, Mapping[str, Any]]:
    """Return two signals of some joints (T, n) each from a file, and its description."""
    array, meta = read_array(stem, [f"{signal}.{joint}" for signal in signals for joint in joints])
    first, second = np.split(array.astype(np.float64), 2, axis=1)
    return first, second, meta


def _columns(row: Mapping[str, Any], velocity: Array, torque: Array) -> Array:
    """Return what one joint's friction may be made of, (T, m - 1): sign, viscous, load, static for each velocity."""
    grid = np.array(row["stribeck_rad_s"])
    tried = regressors(velocity[:, None], torque[:, None], row["smoothing_rad_s"], grid)
    sign = tried["coulomb"][:, :1] + tried["static"][:, :1]
    return np.column_stack([sign, tried["viscous"], tried["load"], tried["static"]])


def _solve(products: Array, terms: Sequence[str], grid: Sequence[float]) -> dict[str, float]:
    """Return the factors of (23) of one joint and the root mean squares before and after [N m].

    Args:
        products: mean products of the columns (m, m).
        terms: terms of `TERMS` that the joint has.
        grid: Stribeck velocities [rad/s].
    """
    found = [_non_negative(products, terms, STATIC + i) for i in range(len(grid))]
    best = min(range(len(grid)), key=lambda i: found[i][1])
    factors, left = found[best]
    if "static" not in terms:
        factors["static"] = factors.get("coulomb", 0.0)
    return {
        **{key: factors.get(term, 0.0) for term, key in TERMS.items()},
        "stribeck_rad_s": grid[best],
        "target_rms_nm": float(np.sqrt(products[-1, -1])),
        "left_rms_nm": left,
    }


def _non_negative(products: Array, terms: Sequence[str], static: int) -> tuple[dict[str, float], float]:
    """Return the factors, none negative, that leave the smallest mean square, and the root of that [N m].

    A square root of the columns' mean products stands for the columns: least squares do not see the difference.
    """
    unit = np.eye(len(products))
    faded = unit[static] if "static" in terms else 0.0
    mixed = {"coulomb": unit[SIGN] - faded, "static": unit[static], "viscous": unit[VISCOUS], "load": unit[LOAD]}
    chosen = np.array([*(mixed[term] for term in terms), unit[-1]])
    values, vectors = np.linalg.eigh(chosen @ products @ chosen.T)
    root = (vectors * np.sqrt(np.maximum(values, 0.0))).T
    size = np.linalg.norm(root[:, :-1], axis=0)
    size[size == 0] = 1.0  # a joint that never moved
    factors, left = nnls(root[:, :-1] / size, root[:, -1])
    return dict(zip(terms, (factors / size).tolist(), strict=True)), float(left)
