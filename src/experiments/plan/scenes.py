"""A scene of the page on which a reader plays with pushes: which runs it shows, and which push."""

from collections.abc import Mapping
from dataclasses import dataclass

from experiments.plan.runs import Run
from mobnet.settings.data import Push


@dataclass(frozen=True)
class PageScene:
    """A scene of the page: its texts, one run of each method, the limbs shown, and which of the pushes it shows.

    Attributes:
        push: text of the button of its push.
        plant: text of the button of its plant.
        runs: one run of each method on one recording.
        limbs: those whose joints are shown.
        joint: the one that is shown first.
        threshold_nm: where the slider of the threshold begins [N m].
        pushes: those of the scenario, in their order.
        name: name of the push that is shown, the first of it; None where any push counts.
        from_s: time from which on the push may begin [s].
    """

    push: str
    plant: str
    runs: tuple[Run, ...]
    limbs: tuple[str, ...]
    joint: str
    threshold_nm: float
    pushes: Mapping[str, Push]
    name: str | None = None
    from_s: float = 0.0
