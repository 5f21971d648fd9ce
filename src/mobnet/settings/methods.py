"""Estimators and ablations: a row is an estimator (Tables 5 to 10, sections 5 and 6)."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import AfterValidator, JsonValue

from mobnet.formats import base
from mobnet.formats.base import Section
from mobnet.kernel.detecting import Target as Target

Networks = Annotated[tuple[base.NetworkName, ...], AfterValidator(base.distinct)]


class ObserverSettings(Section):
    """The momentum observer (7), and what recordings hold of the motors' torque."""

    gain_hz: base.GainHz
    torque: base.TorqueKind


class Method(Section):
    """An estimator.

    `fitted` names networks of Table 1 whose joints are fitted without a network, on the training set of that network.
    With `of` it runs on another method: on its output, or, if it has networks of its own, on its fit. `start` names the
    method from whose networks its own are fine-tuned, `networks_of` another method whose network of a limb it runs
    instead of one of its own. `options` are numbers of its kind, which checks them.
    """

    kind: base.Text
    target: Target | None = None
    limbs: Networks = ()
    network: base.Change = {}
    learning: base.Change = {}
    fitted: Networks = ()
    of: base.SourceName | None = None
    start: base.MethodName | None = None
    networks_of: dict[base.NetworkName, base.MethodName] = {}
    options: dict[str, JsonValue] = {}


class Sweep(Section):
    """A method for each value of one key, section 6.3."""

    of: base.MethodNames
    limb: base.NetworkName
    experiment: base.ExperimentName
    section: Literal["network", "learning"]
    values: base.Rising[base.Count]


def swept_name(base: str, key: str, value: int) -> str:
    """Return the name of the method that stands for one value of a sweep."""
    return f"{base}-{key.replace('_', '-')}-{value}"


def swept_names(key: str, sweep: Sweep) -> list[str]:
    """Return the names of all methods that a sweep stands for."""
    return [swept_name(base, key, value) for base in sweep.of for value in sweep.values]
