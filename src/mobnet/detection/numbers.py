"""What detectors are made with, from the sections of a configuration.

A job is made again where this code changes; the code of sections is no part of what it rests on.
"""

from mobnet.kernel.detecting import ContactNumbers, GateNumbers, TailNumbers, WatchedSignals
from mobnet.settings.detection import ContactPoint, DetectorSettings, SwingGate, Thresholds


def gate_numbers(gate: SwingGate) -> GateNumbers:
    """Return what the gate of a leg is made with."""
    return GateNumbers(**gate.model_dump(exclude={"method"}))


def tail_numbers(thresholds: Thresholds) -> TailNumbers:
    """Return how thresholds for a rate of false alarms are made."""
    return TailNumbers(
        tail_share=thresholds.tail_share,
        on_average=thresholds.on_average,
        least_swings=thresholds.least_swings,
        resamples=thresholds.resamples,
        confidence=thresholds.confidence,
    )


def watched_signals(detector: DetectorSettings) -> WatchedSignals:
    """Return what a detector watches of an estimate."""
    return WatchedSignals(**detector.model_dump(exclude={"method"}))


def contact_numbers(contact: ContactPoint) -> ContactNumbers:
    """Return what contacts are sought with."""
    return ContactNumbers(**contact.model_dump())
