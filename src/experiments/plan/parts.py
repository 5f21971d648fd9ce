"""The parts of jobs that make several things one after another: recordings, networks, estimates, walks."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from experiments.plan.runs import Run
from experiments.settings.scales import ReactionSizes
from mobnet.settings.data import Push
from mobnet.settings.methods import Method
from mobnet.settings.networks import Training
from mobnet.settings.walking import WalkSettings


@dataclass(frozen=True)
class Shard:
    """A recording to make, and the observer's residual of it; both are named without the ending of their files.

    Attributes:
        seed: of its random numbers.
        recording: where it is written.
        residual: where its residual is written.
        motion: of the upper body; None where that holds its posture.
    """

    seed: int
    recording: Path
    residual: Path
    motion: Path | None


@dataclass(frozen=True)
class Repetition:
    """A network to train.

    Attributes:
        training: all that the training takes.
        seed: number of the repetition.
        out: folder of the network.
        state: folder of its checkpoint.
        start: weights from which it is fine-tuned; None of one that learns from the first.
    """

    training: Training
    seed: int
    out: Path
    state: Path
    start: Path | None = None


@dataclass(frozen=True)
class MethodRun:
    """A method that runs on recordings.

    Attributes:
        method: its name.
        methods: its row and, if it runs on another method, that one too, by name.
        networks: folders of its networks by limb, which may be some of the method's.
        fitted: what rule `fit` wrote; None for a method that is not fitted.
        outs: where the estimate of each recording is written, without an ending.
        joints: those that the files hold; all that the method estimates without them.
    """

    method: str
    methods: Mapping[str, Method]
    networks: Mapping[str, Path]
    fitted: Path | None
    outs: tuple[Path, ...]
    joints: tuple[str, ...] | None = None


@dataclass(frozen=True)
class CaseWalks:
    """The walks of a case of `reaction.cases` to make.

    Attributes:
        case: its name.
        settings: its scenario on a robot.
        seeds: of the walks; the first `sizes.compared` of them also with what the case compares.
        sizes: numbers of walks, and the longest duration of one.
        out: file of the trials.
        course: where the course of the first walk is written, without an ending; None where nothing pushes.
    """

    case: str
    settings: WalkSettings
    seeds: Sequence[int]
    sizes: ReactionSizes
    out: Path
    course: Path | None


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
