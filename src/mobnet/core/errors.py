"""Errors a user can act on: one line that names the bad value and what is accepted."""

from collections.abc import Iterable


class MobnetError(Exception):
    """Root of every error this package raises on purpose."""


class ConfigError(MobnetError):
    """A key or a value of the configuration is not accepted."""


class DataError(MobnetError):
    """A recording or a result file is missing, damaged or incomplete."""


class TrainingError(MobnetError):
    """Training diverged or met numbers that are not finite."""


class SimulationError(MobnetError):
    """The plant could not be simulated as asked."""


class DrawingError(MobnetError):
    """The machine lacks what drawing needs."""


def not_accepted(what: str, value: object, accepted: Iterable[object]) -> str:
    """Return the house's one-line message for a value outside a closed set."""
    return f"{what}: {value!r} is not accepted; accepted: {', '.join(sorted(map(str, accepted)))}"
