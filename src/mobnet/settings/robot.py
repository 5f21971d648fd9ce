"""A robot's table of figures."""

from __future__ import annotations

from mobnet.core.joints import JointLayout, layout_of
from mobnet.settings.base import Section
from mobnet.settings.networks import Limb


class Order(Section):
    """Names of the joints in the order of the generalized velocity."""

    virtual: tuple[str, ...]
    actuated: tuple[str, ...]


class RobotTable(Section):
    """All figures of a robot (work in progress: parts that are not typed yet are accepted as they are)."""

    model_config = {"extra": "allow", "frozen": True}

    name: str
    order: Order
    groups: dict[str, tuple[str, ...]]
    networks: dict[str, Limb]

    @property
    def layout(self) -> JointLayout:
        """Joints and limbs."""
        return layout_of(self.order.model_dump(), self.groups)
