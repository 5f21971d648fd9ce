"""Handling collisions (sections 5.4 and 7): identification, reacting steps, stop mode."""

from pathlib import Path

from pydantic import Field

from mobnet.core.detections import LARGEST
from mobnet.core.place import CONFIGS
from mobnet.formats import base
from mobnet.formats.base import Section
from mobnet.formats.loading import load_section
from mobnet.kernel.detecting import Strategy
from mobnet.settings.data import Wrench


class WrenchIdentification(Section):
    """Damping of the contact Jacobian's inverse: errors of torques, and wrenches that are large."""

    torque_error_nm: base.Real = Field(ge=0.01, le=100)
    force_n: base.Real = Field(ge=10, le=1e5)
    moment_nm: base.Real = Field(ge=1, le=1e4)


class FirstStep(Section):
    """How far a foot that is in the air may be sent elsewhere: it need not be fast, and lands where it can carry."""

    height_ratio: base.Real = Field(ge=0, le=20)
    foot_speed_m_s: base.Real = Field(ge=0.01, le=10)
    behind_m: base.Real = Field(ge=0, le=1)
    clear_m: base.Real = Field(ge=0, le=1)


class Compliant(Section):
    """Compliant Stepping Planning, (24) and Figure 21."""

    steps: base.Count
    step_m: base.Length


class Rewind(Section):
    """Rewind Stepping Planning: footsteps that are kept, and how many are walked back."""

    kept: base.Count
    steps: base.Count


class Watch(Section):
    """A detector and the rule of its thresholds; `force sensors` are those of the feet, `none` is no reaction.

    A reaction waits `wait_s` [s] after the alarm. With `wrench`, the controller gets another than the scenario says.
    Motors of the leg that swings make up for the share `feed_forward` of what the networks say the model gets wrong.
    """

    detector: base.WatchName
    rule: base.ThresholdsName = LARGEST
    wait_s: base.Real = Field(default=0.0, ge=0, le=5)
    wrench: Wrench | None = None
    feed_forward: base.Share = 0.0


class Case(Section):
    """What is walked into, or walked freely, how the robot reacts, and what is compared beside our detector.

    With `waits_s` [s] our reaction is also made that much later. `leg` is the one that the obstacle is in front of: its
    contacts that begin in mid-swing are also counted by themselves. With `limbs`, networks of these alone run in the
    loop, and nothing else is watched: a walk that only counts falls and false reactions takes half the time.
    """

    scenario: base.ScenarioName
    strategy: Strategy
    leg: base.LimbName | None = None
    limbs: base.Distinct[base.LimbName] = ()
    compared: tuple[Watch, ...] = ()
    waits_s: tuple[base.Pause, ...] = ()


class Reaction(Section):
    """Numbers of the pipeline of section 7, and the walks on which it is tried."""

    identification: WrenchIdentification
    first_step: FirstStep
    compliant: Compliant
    rewind: Rewind
    step_s: base.Real = Field(ge=0.2, le=3)
    stop_steps: base.Whole = Field(ge=0, le=50)
    watched: base.Distinct[base.LimbName]
    estimator: base.LearnedName
    ours: Watch
    cases: dict[base.LowerName, Case]
    after_s: base.Real = Field(ge=0.1, le=60)
    calm_s: base.Real = Field(ge=1, le=3600)
    gap_s: base.Real = Field(ge=0.001, le=1)
    touch_n: base.Real = Field(ge=0.1, le=100)


def watches_of(reaction: Reaction, case: str) -> tuple[Watch, ...]:
    """Return our detector, then what a case compares with it, and our detector with reactions that wait."""
    ours = reaction.ours
    row = reaction.cases[case]
    return ours, *row.compared, *(ours.model_copy(update={"wait_s": wait_s}) for wait_s in row.waits_s)


def load_reaction(folder: Path = CONFIGS) -> Reaction:
    """Read and check section `reaction`, which only a walking robot needs.

    Raises:
        ConfigError: the file, a key or a value is not accepted; one line for each of them.
    """
    return load_section(folder / "reaction.yaml", Reaction, "reaction")
