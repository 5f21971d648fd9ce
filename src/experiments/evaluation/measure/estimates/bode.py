"""Gain and phase of an estimate: its answer to sines that are injected as torques of joints."""

import numpy as np
from numpy.typing import NDArray

from experiments.evaluation.compare.pair import Measured, Measures, Pair
from experiments.evaluation.compare.scene import Scene, shown_pushes
from experiments.evaluation.compare.windows import flagged_spans
from experiments.settings.measures import Bode
from mobnet.core.arrays import Array
from mobnet.kernel.low_pass import exact_pole

GAIN, PHASE = "gain_{:g}hz", "phase_{:g}hz"  # with the frequency after which a band of lines is named


def measure(pair: Pair, scene: Scene, settings: Bode) -> Measures:
    """Yield gain [-] and phase [deg] of each joint at its line of each band: `gain_2hz`, `phase_2hz` and so on.

    The transfer function is the cross-spectrum of the injected torque and of what the estimate shows of it, over the
    spectrum of the injected torque, at the line (Hann window over the whole injection). Nothing is divided by what the
    walk alone does at this frequency, and contact forces that answer the injection are no part of it.
    """
    shown = shown_pushes(pair, scene)
    spans = flagged_spans(scene.pushed, pair.spans, 0)
    for k, band_hz in enumerate(settings.bands_hz):
        response = np.full(len(pair.joints), np.nan, dtype=complex)
        for joint, frequencies in scene.asked.lines.items():
            if spans and joint in pair.joints:
                place = pair.joints.index(joint)
                (start, end) = max(spans, key=lambda span: span[1] - span[0])
                signals = shown.push[start:end, place], shown.estimate[start:end, place]
                # Over the whole injection, lines of other joints and of the gait do not leak into this one
                # (docs/notes/measures.md).
                response[place] = transfer(*signals, frequencies[k], pair.rate_hz)
        yield Measured(GAIN.format(band_hz), np.abs(response))
        yield Measured(PHASE.format(band_hz), np.angle(response, deg=True))


def transfer(injected: NDArray[np.float64], shown: NDArray[np.float64], frequency_hz: float, rate_hz: float) -> complex:
    """Return S_xy / S_xx [-] of injected x and shown y (T,) [N m] at a frequency, Hann window; nan if x is zero."""
    wave = np.hanning(len(injected)) * np.exp(-2j * np.pi * frequency_hz / rate_hz * np.arange(len(injected)))
    x = wave @ injected
    y = wave @ shown
    return complex(np.conj(x) * y / np.abs(x) ** 2) if np.abs(x) > 0.0 else complex(np.nan, np.nan)


def observer_response(frequency_hz: NDArray[np.float64], gain_hz: float, rate_hz: float) -> Array:
    """Return the response [-] (n,) of the observer's low-pass, gain K_0 of (7) [1/s], as it is sampled: (11)."""
    pole = exact_pole(gain_hz, rate_hz)
    return (1.0 - pole) / (1.0 - pole * np.exp(-2j * np.pi * frequency_hz / rate_hz))
