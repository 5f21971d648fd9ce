"""How friction, rotor inertia and a payload are identified from logs of free motion, `./reproduce identify`."""

from typing import Annotated

from pydantic import Field

from mobnet.settings.base import Count, InnerShare, Positive, Rising, Seconds, Section


class Identification(Section):
    """How a log becomes a joint's numbers.

    Attributes:
        low_pass_hz: corner of the low-pass without delay behind which everything is fitted [Hz].
        window_s: length of the windows, one of which at a time is left out for the intervals [s].
        least_windows: fewest windows with which anything is identified.
        held_out: share of the windows, the last ones of each log, on which the fit is tried that does not know them.
        folds: parts of the other windows, each of which is held out once to choose the smooth sign of a joint.
        smoothing_rad_s: widths of the smooth sign of which a joint takes the best [rad/s].
        breakaway_rad: angles of Dahl's law, the same [rad].
        gain: share by which Dahl's law must lower the error on the parts held out.
        mass_share: standard deviation of the share by which a link's mass and inertia differ from those of the table.
        com_m: the same of its centre of mass, along each axis [m].
        payload_kg_m3: density of a payload, which is taken for a ball [kg/m^3].
        least_speed_rad_s: root mean square speed below which a joint did not move [rad/s].
        confidence: nominal one of the intervals.
    """

    low_pass_hz: Annotated[Positive, Field(le=1000)]
    window_s: Seconds
    least_windows: Annotated[Count, Field(ge=10)]
    held_out: Annotated[InnerShare, Field(le=0.5)]
    folds: Annotated[Count, Field(ge=2, le=50)]
    smoothing_rad_s: Rising[Annotated[Positive, Field(ge=1e-4, le=20)]]
    breakaway_rad: Rising[Annotated[Positive, Field(ge=1e-5, le=1)]]
    gain: InnerShare
    mass_share: InnerShare
    com_m: Annotated[Positive, Field(le=1)]
    payload_kg_m3: Annotated[Positive, Field(ge=10, le=30_000)]
    least_speed_rad_s: Positive
    confidence: InnerShare
