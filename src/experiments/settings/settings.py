"""The whole configuration, and what a walk takes of it; other jobs take whole sections."""

from typing import Annotated, Literal

from pydantic import Field

from experiments.settings.claims import Claim, ClaimName
from experiments.settings.evaluation import Evaluation
from experiments.settings.published import Published
from experiments.settings.scales import Scale
from experiments.settings.trials import Trials
from mobnet.core.joints import JointLayout
from mobnet.formats.base import (
    Flag,
    LowerName,
    RowName,
    ScaleName,
    Section,
    Whole,
)
from mobnet.settings.data import (
    Commands,
    Development,
    Motion,
    Obstacle,
    Push,
    RandomTorque,
    RecordingSettings,
    Scenario,
    Terrain,
    TrainingSet,
)
from mobnet.settings.lab import Lab
from mobnet.settings.methods import Method, Sweep, swept_names
from mobnet.settings.reaction import Reaction
from mobnet.settings.surrogate import Fleet, Level, Surrogate
from mobnet.settings.walking import Walking


class StackSettings(Section):
    """Networks of one shape that learn side by side, `most` of them in a stack."""

    side_by_side: Literal["auto"] | Flag
    most: Whole = Field(ge=1, le=1024)


class Settings(Lab):
    """Every number of the artifact, once; to `seed` jobs add their names."""

    scale: ScaleName
    keep: Literal["all", "tables"]
    levels: Annotated[dict[LowerName, Level], Field(min_length=1)]
    surrogate: Surrogate
    fleet: Fleet
    walking: Walking
    terrain: Terrain
    commands: Commands
    random_torque: RandomTorque
    motions: dict[LowerName, Motion]
    pushes: dict[LowerName, Push]
    obstacles: dict[LowerName, Obstacle]
    scenarios: Annotated[dict[LowerName, Scenario], Field(min_length=1)]
    training_sets: Annotated[dict[LowerName, TrainingSet], Field(min_length=1)]
    recording: RecordingSettings
    stacks: StackSettings
    methods: Annotated[dict[RowName, Method], Field(min_length=1)]
    sweeps: dict[Annotated[str, Field(pattern="^[a-z_]+$")], Sweep]
    development: Annotated[dict[LowerName, Development], Field(min_length=1)]
    trials: Trials
    reaction: Reaction
    evaluation: Evaluation
    scales: Annotated[dict[LowerName, Scale], Field(min_length=1)]
    published: Published
    claims: dict[ClaimName, Claim]

    @property
    def layout(self) -> JointLayout:
        """Joints and limbs of the robot."""
        return self.robot.layout

    @property
    def sizes(self) -> Scale:
        """The chosen scale."""
        return self.scales[self.scale]

    def with_own_sweeps(self) -> "Settings":
        """Return the settings with the values of sweeps that the chosen scale tries, and claims about these alone.

        The sweep of Figure 20 also has the size of the network itself, whatever that is.
        """
        sweeps = dict[str, Sweep]()
        left_out = set[str]()
        figure = self.evaluation.figure_20
        for key, row in self.sweeps.items():
            values = self.sizes.sweeps.get(key, row.values)
            if key == figure.parameters:
                network_size = getattr(self.networks[figure.limb], figure.parameters)
                values = tuple(sorted({*values, network_size}))
            sweeps[key] = row.model_copy(update={"values": values})
            left_out |= {*swept_names(key, row)} - {*swept_names(key, sweeps[key])}
        claims = dict[str, Claim]()
        for name, claim in self.claims.items():
            cells = tuple(cell for cell in claim.cells if cell.method not in left_out)
            claims[name] = claim.model_copy(update={"cells": cells})
        return self.model_copy(update={"sweeps": sweeps, "claims": claims})

    def test_s(self, scenario: str) -> float:
        """Return the duration of a test's recordings at the chosen scale [s]."""
        return self.sizes.durations_s.get(scenario, self.sizes.test.shard_s)

    @property
    def detection_walks(self) -> tuple[str, ...]:
        """The tests of the detectors of collisions; no errors are scored in them."""
        detection = self.detection
        return detection.collisions, detection.sweep, detection.place, detection.random
