"""What an estimator is built from: a method, what the observer knows, and the files that belong to the method.

The workflow reads kinds before it starts, for their options. So this module and the kinds import quickly: the observer,
which needs Pinocchio, is imported when one is built.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import TypeVar

from pydantic import ValidationError

from mobnet.core.errors import ConfigError, not_accepted
from mobnet.core.estimator import ResidualObserver
from mobnet.core.joints import JointLayout
from mobnet.formats.base import Section
from mobnet.formats.faults import problems
from mobnet.formats.reading import dotted
from mobnet.formats.robot import RobotTable
from mobnet.learning.deployed.limbs import LimbNetworks
from mobnet.learning.deployed.loading import load_limb_networks
from mobnet.robot.description import describe
from mobnet.settings.methods import Method, ObserverSettings

Kind = TypeVar("Kind", bound=Section)


@dataclass(frozen=True)
class Recipe:
    """All that `build` of a kind of estimator may use.

    Attributes:
        name: the method's name.
        methods: the method and, if it runs on another one, that one too, by name.
        robot: the robot's table.
        mass_ratio: masses of the observer's nominal model over those of the table (section 5.1).
        gravity_m_s2: acceleration of gravity [m/s^2].
        observing: the observer's settings.
        rate_hz: samples per second [Hz].
        networks: limb -> folder of its trained network, for some limbs of the method; empty where it has none.
        fitted: file that rule `fit` wrote; None for a method that is not fitted.
        shared: an observer of the same robot and settings that other estimators run too; None for one of its own.
    """

    name: str
    methods: Mapping[str, Method]
    robot: RobotTable
    mass_ratio: float
    gravity_m_s2: float
    observing: ObserverSettings
    rate_hz: float
    networks: Mapping[str, Path] = field(default_factory=dict)
    fitted: Path | None = None
    shared: ResidualObserver | None = None

    def __post_init__(self) -> None:
        """Check that the files are those that the method needs.

        Raises:
            ConfigError: the method is unknown, or networks or fit are not the ones that it names.
        """
        source = self._row(self.method.of or self.name)
        limbs = self.method.limbs or source.limbs
        if bool(limbs) != bool(self.networks) or not set(limbs).issuperset(self.networks):
            accepted = f"some of {sorted(limbs)}" if limbs else "none"
            raise ConfigError(not_accepted(f"networks of method {self.name}", sorted(self.networks), [accepted]))
        if bool(source.fitted) != (self.fitted is not None):
            accepted = "the file that rule `fit` writes" if source.fitted else "none"
            raise ConfigError(f"method {self.name!r} with the fit {self.fitted}; accepted: {accepted}")

    def _row(self, name: str) -> Method:
        if name not in self.methods:
            raise ConfigError(not_accepted("method", name, self.methods))
        return self.methods[name]

    @property
    def method(self) -> Method:
        """The method."""
        return self._row(self.name)

    @property
    def layout(self) -> JointLayout:
        """The robot's joints."""
        return describe(self.robot).layout

    def options(self, section: type[Kind]) -> Kind:
        """Return the method's own numbers as the section `Options` of its kind."""
        return options_of(self.name, self.method, section)

    def observer(self) -> ResidualObserver:
        """Return the momentum observer of the level's nominal model."""
        if self.shared is not None:
            return self.shared
        from mobnet.estimation.observe import observer_of

        gain_hz = self.observing.gain_hz
        torque = self.observing.torque
        return observer_of(describe(self.robot), self.mass_ratio, self.gravity_m_s2, gain_hz, self.rate_hz, torque)

    def limb_networks(self) -> LimbNetworks | None:
        """Return the method's networks side by side, or None if it names no limbs."""
        return load_limb_networks(self.networks, self.layout) if self.networks else None


def options_of(name: str, method: Method, section: type[Kind]) -> Kind:
    """Return a method's own numbers as the section of its kind.

    Raises:
        ConfigError: one line for each number that is not accepted.
    """
    try:
        return section.model_validate(method.options)
    except ValidationError as error:
        faults = problems(error, section, method.options)
        lines = [f"methods.{name}.options.{dotted(place)}: {text}" for place, text in faults]
        raise ConfigError("\n".join(lines)) from None
