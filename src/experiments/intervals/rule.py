"""What is asked of all intervals, and what is taken as possible where few clusters cannot tell."""

from typing import NamedTuple, Protocol


class IntervalRule(Protocol):
    """What an interval is made by; a section of a configuration may have these fields, or a `IntervalNumbers`.

    Attributes:
        confidence: how often an interval is to hold the truth [-], from .5 to below 1.
        most_correlation: of whether something happens in two trials of a cluster [-], above 0 and below 1.
        most_variation: standard deviation of a rate over clusters, as a part of the rate [-], above 0.
    """

    @property
    def confidence(self) -> float:
        """How often an interval is to hold the truth [-]."""
        ...

    @property
    def most_correlation(self) -> float:
        """The most that two trials of a cluster are taken to be correlated [-]."""
        ...

    @property
    def most_variation(self) -> float:
        """The most that a rate is taken to vary over clusters, as a part of itself [-]."""
        ...


class IntervalNumbers(NamedTuple):
    """Numbers for intervals; see `IntervalRule`."""

    confidence: float
    most_correlation: float
    most_variation: float
