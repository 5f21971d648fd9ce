"""Estimators and ablations: a row is an estimator (Tables 5 to 10, sections 5 and 6)."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field, JsonValue, model_validator

from mobnet.settings.base import (
    Change,
    Count,
    ExperimentName,
    MethodNames,
    NetworkName,
    Positive,
    Section,
    SourceName,
    Text,
)  # fmt: skip

Target = Literal["uncertainty", "external"]


class Observer(Section):
    """The momentum observer (7).

    Attributes:
        torque: what recordings hold of the motors' torque: its `mean` over the interval that ends at the tick, as the
            simulator writes it, or a `sample` at the tick.
    """

    gain_hz: Positive
    torque: Literal["mean", "sample"]


class Method(Section):
    """An estimator.

    Attributes:
        kind: module of `mobnet.estimation.kinds`.
        target: what its networks learn, the uncertainty torque (13) or the external torque.
        limbs: networks of Table 1 that are trained for it and that it runs on.
        network: keys of its networks that it changes.
        learning: keys of section `learning` that it changes.
        fitted: networks of Table 1 whose joints are fitted without a network, on the training set of that network.
        of: another method, on whose networks or fit it runs.
        options: numbers of its kind, which checks them.
    """

    kind: Text
    target: Target | None = None
    limbs: tuple[NetworkName, ...] = ()
    network: Change = {}
    learning: Change = {}
    fitted: tuple[NetworkName, ...] = ()
    of: SourceName | None = None
    options: dict[str, JsonValue] = {}

    @model_validator(mode="after")
    def _learns_something(self) -> Method:
        """Check that a target and limbs come together."""
        if bool(self.limbs) != (self.target is not None):
            raise ValueError("`target` and `limbs` are accepted together only")
        return self


class Sweep(Section):
    """A method for each value of one key, section 6.3."""

    of: MethodNames
    limb: NetworkName
    experiment: ExperimentName
    section: Literal["network", "learning"]
    values: Annotated[tuple[Count, ...], Field(min_length=1)]
