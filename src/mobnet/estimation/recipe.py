"""What an estimator is made of: a method's row and the files that belong to it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from pathlib import Path
from typing import Any

from mobnet.core.errors import ConfigError, not_accepted
from mobnet.core.methods import method_row, source_of
from mobnet.estimation.observe import observer_of
from mobnet.estimation.observer import MomentumObserver
from mobnet.learning.limbs import LimbNetworks, load_limb_networks
from mobnet.robot.description import RobotDescription, load_robot


@dataclass(frozen=True)
class Recipe:
    """All that `build` of a kind of estimator may use.

    Attributes:
        config: resolved configuration.
        method: row of its methods.
        level: uncertainty level of section 5.1, which says how wrong the observer's nominal model is.
        rate_hz: samples per second [Hz].
        networks: limb -> folder of its trained network; empty for a method without limbs.
        fitted: file of what `fit` of the kind found; None for a method that is not fitted.
    """

    config: Mapping[str, Any]
    method: str
    level: str
    rate_hz: float
    networks: Mapping[str, Path] = field(default_factory=dict)
    fitted: Path | None = None

    def __post_init__(self) -> None:
        """Check that the files are those that the method needs.

        Raises:
            ConfigError: the method is unknown, or networks or fit are not the ones that its row names.
        """
        row = method_row(self.config, source_of(self.config, self.method))
        limbs = row.get("limbs", [])
        if set(limbs) != set(self.networks):
            raise ConfigError(not_accepted(f"networks of method {self.method}", sorted(self.networks), [sorted(limbs)]))
        if ("fitted" in row) != (self.fitted is not None):
            accepted = "the file that rule `fit` writes" if "fitted" in row else "none"
            raise ConfigError(f"method {self.method!r} with the fit {self.fitted}; accepted: {accepted}")

    @property
    def row(self) -> Mapping[str, Any]:
        """The method's row."""
        return method_row(self.config, self.method)

    @cached_property
    def robot(self) -> RobotDescription:
        """The robot's table."""
        return load_robot(Path(self.config["robot"]))

    def observer(self) -> MomentumObserver:
        """Return the momentum observer of the level's nominal model.

        Raises:
            ConfigError: the level is not configured.
        """
        return observer_of(self.config, self.robot, self.level, self.rate_hz)

    def limb_networks(self) -> LimbNetworks | None:
        """Return the method's networks side by side, or None if it names no limbs.

        Raises:
            DataError: weights are missing or damaged.
        """
        return load_limb_networks(self.networks, self.robot.layout) if self.networks else None
