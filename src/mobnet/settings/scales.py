"""Sizes of the tests and of the trainings."""

from pydantic import Field

from mobnet.settings.base import Count, NotNegative, Positive, Section, Seeds, Share
from mobnet.settings.data import Recordings


class Experiment(Section):
    """How long and how often networks are trained; an epoch is all training samples or `epoch_samples` of them."""

    epochs: Count
    epoch_samples: Count | None = None
    seeds: Seeds


class Scale(Section):
    """One size of every test and of every training; the last four replace numbers of other sections."""

    test: Recordings
    experiments: dict[str, Experiment] = Field(min_length=1)
    batch_size: Count | None = None
    stream_s: Positive | None = None
    rate_decay_share: Share | None = None
    figure_start_s: NotNegative | None = None
