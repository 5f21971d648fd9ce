"""Sizes of the training sets, the tests and the trainings."""

from __future__ import annotations

from pydantic import Field

from mobnet.settings.base import Count, LevelName, NotNegative, Positive, ScenarioName, Section, Seeds, Share


class TrainingSet(Section):
    """Recordings that networks learn from, section 4.3."""

    scenario: ScenarioName
    level: LevelName
    shards: Count
    shard_s: Positive


class TestSize(Section):
    """Recordings of every test."""

    shards: Count
    shard_s: Positive


class Experiment(Section):
    """How long and how often networks are trained; an epoch is all training samples or `epoch_samples` of them."""

    epochs: Count
    epoch_samples: Count | None = None
    seeds: Seeds


class Scale(Section):
    """One size of everything; the last four replace numbers of other sections."""

    train: dict[str, TrainingSet] = Field(min_length=1)
    test: TestSize
    experiments: dict[str, Experiment] = Field(min_length=1)
    batch_size: Count | None = None
    stream_s: Positive | None = None
    rate_decay_share: Share | None = None
    figure_start_s: NotNegative | None = None
