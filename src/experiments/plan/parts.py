"""What jobs get that run several methods or make several walks."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from experiments.plan.runs import Run
from experiments.settings.scales import ReactionSizes
from mobnet.settings.data import Push
from mobnet.settings.methods import Method
from mobnet.settings.walking import WalkSettings

TOGETHER_S = 960.0  # recordings of so long are held in memory and run side by side [s]: 1.3 GB


@dataclass(frozen=True)
class MethodRun:
    """A method that runs on recordings.

    Attributes:
        method: its name.
        methods: its row and, if it runs on another method, that one too, by name.
        networks: folders of its networks by limb, which may be some of the method's.
        fitted: what rule `fit` wrote; None for a method that is not fitted.
        network_seed: of its networks.
        joints: those that the files hold; all that the method estimates without them.
    """

    method: str
    methods: Mapping[str, Method]
    networks: Mapping[str, Path]
    fitted: Path | None
    network_seed: int
    joints: tuple[str, ...] | None = None


@dataclass(frozen=True)
class CaseWalks:
    """The walks of a case of `reaction.cases` to make.

    Attributes:
        case: its name.
        settings: its scenario on a robot.
        seeds: of the walks; the first `sizes.compared` of them also with what the case compares.
        sizes: numbers of walks, and the longest duration of one.
        is_pushed: whether the robot walks into something, or something pushes it.
    """

    case: str
    settings: WalkSettings
    seeds: Sequence[int]
    sizes: ReactionSizes
    is_pushed: bool


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
        gate: method whose estimate tells of an early contact.
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
    gate: str
    pushes: Mapping[str, Push]
    name: str | None = None
    from_s: float = 0.0
