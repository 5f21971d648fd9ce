"""Scores: errors of a method on a run, as the files of scores have them."""

from dataclasses import dataclass, fields


@dataclass(frozen=True)
class Score:
    """One number measured on one run: a row of a file of scores.

    The network seed of a method without networks is 0; on a surrogate robot every method has the seed of the robot's
    networks. `joint` is a joint of the limb, or `avg`, the mean over the limb's joints of this unit; `metric` is a name
    of `metrics.METRICS`, or of a push.
    """

    scenario: str
    level: str
    method: str
    network_seed: int
    test_seed: int
    limb: str
    joint: str
    metric: str
    value: float
    unit: str


SCORES = tuple(field.name for field in fields(Score))
