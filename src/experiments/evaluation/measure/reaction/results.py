"""Trials of reactions, measured and summarised: falls, forces, delays, directions, and reactions to nothing."""

from collections.abc import Mapping

import pandas as pd

from experiments.evaluation.measure.detection.results import MS
from experiments.evaluation.measure.estimates.changed import HOUR_S
from experiments.evaluation.number.frames import rows_of
from experiments.evaluation.number.laws import Law, clusters, mean, share
from experiments.evaluation.number.number import Number
from experiments.intervals.clusters import rate_in
from experiments.records.reactions import NONE
from experiments.settings.published import PublishedContacts
from experiments.settings.reaction_tables import Safety
from experiments.settings.runs import Statistics
from mobnet.settings.reaction import Watch

FALLS = "falls"
PEAK = "first_peak"
FIRST = "first_impulse"
IMPULSE = "impulse"
MEDIAN = "median_impulse"
HEAVY = "heavy"
NOTICED = "noticed"
ALARM = "alarm"
WITHIN = "within"
BASE_WITHIN = "base_within"
EARLY = "early"
SWING = "{}, in swing"  # a case, of which those walks are meant whose contact began in mid-swing
GROUP = ["case", "detector", "rule", "wait_s", "wrench", "feed_forward"]  # what walks are made with
MILLI = 1e3  # mm in a metre, mrad in a radian
FALLEN = "falls"
REACTED = "false reactions"
VELOCITY = "error of the base's velocity"
TRACKING = "error of the swing leg"
POWER = "power"


def trials_of(trials: pd.DataFrame, case: str, watch: Watch) -> pd.DataFrame:
    """Return the trials of a case with what watches it, the wrench of the feet being that of its scenario."""
    return rows_of(trials, case=case, detector=watch.detector, rule=watch.rule, wait_s=watch.wait_s)


def in_swing(trials: pd.DataFrame) -> pd.DataFrame:
    """Return the walks whose first contact began in mid-swing, where section 5.3 watches a leg."""
    return rows_of(trials, in_swing=1)


def with_measures(trials: pd.DataFrame, settings: Safety) -> pd.DataFrame:
    """Return trials with a column for each measure, missing where a walk says nothing about it.

    A robot that reacts before it touches anything says nothing about a collision: `touched` are the others that met the
    obstacle. What carries a robot has no impulse of a collision.
    """
    early = trials["reacted_s"].notna() & ~(trials["contact_s"] <= trials["reacted_s"])
    touched = trials["contact_s"].notna() & ~early
    met = touched & ~trials["case"].isin(settings.stood_on)
    reacts = trials["detector"] != NONE
    angles = {WITHIN: trials["angle_deg"], BASE_WITHIN: trials["base_angle_deg"]}
    within = {name: (angle <= settings.within_deg).where(touched & angle.notna()) for name, angle in angles.items()}
    heavy = trials["impulse_ns"] > settings.heavy_ns
    measures = {
        FALLS: trials["fell_s"].notna(),
        PEAK: trials["first_peak_n"].where(touched),
        FIRST: trials["first_impulse_ns"].where(met),
        IMPULSE: trials["impulse_ns"].where(met),
        HEAVY: heavy.where(met & trials["impulse_ns"].notna()),
        NOTICED: trials["alarm_s"].notna().where(touched & reacts),
        ALARM: (MS * (trials["alarm_s"] - trials["contact_s"])).where(touched),
        **within,
        EARLY: early.where(reacts),
    }
    return trials.assign(touched=touched, **measures)


def outcome_laws(statistics: Statistics) -> Mapping[str, Law]:
    """Return measure -> its law, over robots and walks.

    Impulses lie around two values, those of short contacts and those of a robot that leans on the obstacle, so that
    their mean has the median and the share of large ones beside it. The median has no interval: a few walks of three
    robots do not bound it.
    """

    def median(trials: pd.DataFrame) -> Number:
        impulses = trials[IMPULSE].dropna()
        return Number(float(impulses.median()) if len(impulses) else None, unit="N s")

    return {
        FALLS: share(FALLS, statistics),
        PEAK: mean(PEAK, "N", statistics),
        FIRST: mean(FIRST, "N s", statistics),
        IMPULSE: mean(IMPULSE, "N s", statistics),
        MEDIAN: median,
        HEAVY: share(HEAVY, statistics),
        NOTICED: share(NOTICED, statistics),
        ALARM: mean(ALARM, "ms", statistics),
        WITHIN: share(WITHIN, statistics),
        BASE_WITHIN: share(BASE_WITHIN, statistics),
        EARLY: share(EARLY, statistics),
    }


def outcome_of(trials: pd.DataFrame, settings: Safety, statistics: Statistics) -> dict[str, Number]:
    """Return measure -> what came of some trials; intervals are over robots and walks."""
    rows = with_measures(trials, settings)
    return {name: law(rows) for name, law in outcome_laws(statistics).items()}


def with_walked(trials: pd.DataFrame) -> pd.DataFrame:
    """Return free walks with their time [h], what happened in them, and errors [mm/s, mrad] and power [W]."""
    measures = {
        "hours": trials["walked_s"] / HOUR_S,
        FALLEN: trials["fell_s"].notna(),
        REACTED: trials["reacted_s"].notna(),
        VELOCITY: MILLI * trials["velocity_rmse_m_s"],
        TRACKING: MILLI * trials["tracking_rmse_rad"],
        POWER: trials["power_w"],
    }
    return trials.assign(**measures)


def walked_laws(statistics: Statistics) -> Mapping[str, Law]:
    """Return what happens in free walks -> its law: events in an hour [1/h], and means of the walks."""

    def rate(event: str) -> Law:
        return lambda rows: rate_in(
            rows[event].astype(int).tolist(), rows["hours"].tolist(), clusters(rows), statistics
        )

    rates = {event: rate(event) for event in (FALLEN, REACTED)}
    units = {VELOCITY: "mm/s", TRACKING: "mrad", POWER: "W"}
    return {**rates, **{name: mean(name, unit, statistics) for name, unit in units.items()}}


def printed_of(published: PublishedContacts, case: str, measure: str) -> float | None:
    """Return what the paper prints of a case [N], [N s]; None where that is nothing."""
    contact = getattr(published, case, None)
    return None if contact is None else {PEAK: contact.force_n, IMPULSE: contact.momentum_ns}.get(measure)
