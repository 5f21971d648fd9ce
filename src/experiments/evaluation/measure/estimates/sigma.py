"""How far standard deviations can be trusted in parts of a walk: by phase, by speed, by their own size, over time."""

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from experiments.evaluation.compare.masks import Masks, masked_mean, parts_of, push_parts
from experiments.evaluation.compare.pair import Measured, Measures, Pair, read_std
from experiments.evaluation.compare.rmse import Spans, parts
from experiments.evaluation.compare.scene import Scene
from experiments.evaluation.compare.windows import rows_in
from experiments.settings.measures import Sigma
from mobnet.core.arrays import Array
from mobnet.learning.calibration import half_width

STD, COVER = "std", "cover"  # mean standard deviation [N m], V1..V3 [N], and share of errors in their interval [-]
EXCURSION = "excursion"
MEMORY = "acf_{:g}ms"
FALLEN = np.exp(-1.0)  # correlation below which an excursion has ended
MS = 1000.0


def measure(pair: Pair, scene: Scene, settings: Sigma) -> Measures:
    """Yield what the standard deviations of a run are worth, by phase, speed and pushes too; nothing without any."""
    masks = {**parts_of(pair, scene), **push_parts(pair, scene)}
    return spreads(pair, read_std(pair.run, pair.joints), masks, scene.asked.cover_share, settings)


def spreads(pair: Pair, std: NDArray[np.float32] | None, masks: Masks, share: float, settings: Sigma) -> Measures:
    """Yield what an estimate's standard deviations (T, n) [N m], V1..V3 [N], are worth, joint by joint.

    For all samples and each part of a walk: their mean, `std_<part>`, and the share of errors within the central
    interval of a nominal share, `cover_<part>`. For each of some equally large parts of the samples by their own size
    also the error, `rmse_part_<k>`. Over time: the autocorrelation of the standardised error, and how long it takes to
    fall. Of an estimate without standard deviations there is nothing to tell.
    """
    if std is None:
        return
    error = pair.estimate.astype(np.float64) - pair.truth
    ratio = error / std
    inside = np.repeat(rows_in(pair.spans, len(error))[:, None], error.shape[1], axis=1)
    covered = (np.abs(ratio) <= half_width(share)).astype(np.float64)
    sigma = std.astype(np.float64)
    for name, mask in {"": inside, **{f"_{name}": mask_of for name, mask_of in masks.items()}}.items():
        yield Measured(STD + name, masked_mean(sigma, mask))
        yield Measured(COVER + name, masked_mean(covered, mask))
    rank = ranks(std, inside, settings.parts)
    for k in range(settings.parts):
        mask = rank == k
        yield Measured(f"{STD}_part_{k + 1}", masked_mean(sigma, mask), average_only=True)
        yield Measured(f"rmse_part_{k + 1}", np.sqrt(masked_mean(error**2, mask)), average_only=True)
        yield Measured(f"{COVER}_part_{k + 1}", masked_mean(covered, mask), average_only=True)
    memory = autocorrelation(ratio, pair.spans, round(settings.longest_s * pair.rate_hz))
    for lag_ms in settings.lags_ms:
        yield Measured(MEMORY.format(lag_ms), memory[round(lag_ms * pair.rate_hz / MS)], average_only=True)
    yield Measured(EXCURSION, first_below(memory, float(FALLEN)) * MS / pair.rate_hz)


def ranks(std: NDArray[np.float32], inside: NDArray[np.bool_], count: int) -> NDArray[np.intp]:
    """Return in which of equally large parts, by the size of each joint's std (T, n), a sample lies; -1 outside."""
    edges = np.quantile(std[inside.all(axis=1)], np.arange(1, count) / count, axis=0)
    part = np.stack([np.searchsorted(cuts, column) for cuts, column in zip(edges.T, std.T, strict=True)], axis=1)
    return np.where(inside, part, -1)


def autocorrelation(signal: NDArray[np.float64], spans: Spans, longest: int) -> Array:
    """Return E[x_k x_{k+l}] / E[x_k^2] of each signal (T, n) at lags 0 to `longest` rows, (longest + 1, n) [-].

    The mean is not taken away: a constant error is an excursion that never ends. Products lie within a span
    (start, end); lags that no span has are nan.
    """
    total = np.zeros((longest + 1, signal.shape[1]))
    count = np.zeros(longest + 1)
    for part in parts(signal, spans):
        # Zeros behind the signal keep its end from being multiplied with its beginning.
        size = 2 * len(part)
        lags = min(longest, len(part) - 1) + 1
        spectrum = np.fft.rfft(part, size, axis=0)
        total[:lags] += np.fft.irfft(np.abs(spectrum) ** 2, size, axis=0)[:lags]
        count[:lags] += len(part) - np.arange(lags)
    mean = np.divide(total, count[:, None], out=np.full(total.shape, np.nan), where=count[:, None] > 0)
    return np.divide(mean, mean[0], out=np.full(mean.shape, np.nan), where=mean[0] > 0)


def first_below(memory: Sequence[float] | NDArray[np.float64], level: float) -> Array:
    """Return the first lag (n,) [rows] at which a correlation (L, n) [-] is below a level; L where it never is."""
    low = np.asarray(memory) < level
    return np.where(low.any(axis=0), low.argmax(axis=0), len(low)).astype(np.float64)
