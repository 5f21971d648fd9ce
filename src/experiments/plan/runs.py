"""What tables and figures look at: the runs of an estimator, and variants and sizes of networks."""

from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

from experiments.settings.measures import Scoring
from mobnet.settings.methods import Method
from mobnet.settings.surrogate import Level


@dataclass(frozen=True)
class Run:
    """One run of a method on a test: a network seed, 0 for a method without networks, on a recording.

    On a robot of the fleet, the network seed is that of the robot's networks for any method: runs of a robot belong
    together. The recording, the observer's residual of it and the method's estimate are named without the ending of
    their files. `repeated` are limbs whose network has run on the recording under an earlier seed: they have fewer
    networks than others, and these numbers must not count again.
    """

    scenario: str
    level: str
    method: str
    network_seed: int
    test_seed: int
    recording: Path
    residual: Path
    estimate: Path
    repeated: tuple[str, ...] = ()


@dataclass(frozen=True)
class Tried:
    """A variant of the `base` method with its networks or its fit: what is changed, key -> value.

    `methods` has the variant and the method that it runs on, if there is one; `networks` are the folders by limb.
    """

    base: str
    name: str
    changes: Mapping[str, object]
    methods: Mapping[str, Method]
    networks: Mapping[str, Path]
    fitted: Path | None
    network_seed: int


@dataclass(frozen=True)
class TriedTask:
    """Variants that are tried at a task: the joints of its limb, and the walks of its plant on which they are judged.

    Recordings and the observer's residuals of them are named without the ending of their files.
    """

    level: Level
    joints: tuple[str, ...]
    tried: tuple[Tried, ...]
    recordings: tuple[Path, ...]
    residuals: tuple[Path, ...]


@dataclass(frozen=True)
class TaughtRobot:
    """A robot on which it is tried what the walks of a training set teach: its walks, and those with hits.

    `asked` says which time around the hits counts.
    """

    walk: TriedTask
    hits: TriedTask
    asked: Scoring


@dataclass(frozen=True)
class ExplainedRobot:
    """A robot on which it is asked why a hit is hidden, as the walks of a training set have it.

    `twins` are the recordings of the walks with hits, without the hits, and `paths` what is tried of which it is asked
    by which inputs a hit comes in; both are empty where that is not asked.
    """

    robot: str
    data: str
    taught: TaughtRobot
    twins: tuple[Path, ...]
    paths: tuple[Tried, ...]


@dataclass(frozen=True)
class SweptSize:
    """Networks of one size, or of one amount of data, of the `base` method that a sweep varies (Figure 20)."""

    panel: str
    base: str
    folders: tuple[Path, ...]
