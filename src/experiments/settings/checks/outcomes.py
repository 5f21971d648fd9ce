"""What must hold for claims about counts: at a scale that decides them, some outcome of the run meets their bounds.

A share of few walks, or of the walks of few robots, has a long interval, so that a bound may be out of reach whatever
happens in them. The best outcome is that of alike robots: their walks then count as so many independent ones as have an
interval as wide (`experiments.evaluation.number.clusters`, docs/notes/0022).
"""

from collections.abc import Iterator
from itertools import chain
from math import log, sqrt
from statistics import NormalDist

from experiments.settings.catalogue import Catalogue
from experiments.settings.claims import Cell, Claim
from experiments.settings.settings import Settings
from mobnet.core.claim_ranges import Bounds, ranges_of, within
from mobnet.core.errors import misfit
from mobnet.settings.reading import Problem

HOUR_S = 3600.0
CLUSTERED = ("table_09", "found_by_rate", "safety", "sensorless")  # tables whose intervals are over robots
DIVERGED = "diverged"  # metric of trainings of which a share is claimed


def outcome_problems(catalogue: Catalogue) -> Iterator[Problem]:
    """Yield claims that no outcome of the chosen scale can meet."""
    settings = catalogue.settings
    for name, claim in settings.claims.items():
        bounds = ranges_of(claim).size
        is_decided = not claim.decided_at or settings.scale in claim.decided_at
        if not is_decided or bounds is None or claim.quantity not in ("value", "share") or len(claim.cells) > 1:
            continue
        cell = next(iter(claim.cells))
        trials = trials_of(catalogue, cell)
        hours = hours_of(settings, cell)
        confidence = settings.evaluation.statistics.confidence
        part = independent_part(settings, cell, confidence)
        if trials is not None and not is_met_by_a_share(bounds, trials, part, confidence):
            text = f"a range that no share of {trials} reaches with its interval"
            yield _place(name, claim), misfit(text, f"a wider range, or more of them at scale {settings.scale}")
        if hours is not None and not is_met_by_a_rate(bounds, part * hours, confidence):
            text = f"a range that no count in {hours:.2f} h reaches with its interval"
            yield _place(name, claim), misfit(text, f"a wider range, or longer walks at scale {settings.scale}")


def _place(name: str, claim: Claim) -> tuple[str, ...]:
    return ("claims", name, "bar" if claim.bar else "rule")


def independent_part(settings: Settings, cell: Cell, confidence: float) -> float:
    """Return which part of the trials of a cell is independent at best [-]; 1 where they are no walks of robots."""
    if cell.table not in CLUSTERED:
        return 1.0
    from scipy.special import stdtrit  # pyright: ignore[reportMissingTypeStubs]  # here, as it takes a while to import

    robots = robots_of(settings)
    if robots == 1:
        return 1.0
    tail = (1.0 + confidence) / 2.0
    return (NormalDist().inv_cdf(tail) / float(stdtrit(robots - 1, tail))) ** 2


def is_met_by_a_share(bounds: Bounds, trials: int, part: float, confidence: float) -> bool:
    """Return whether some share of so many trials has its interval within bounds [-]; a part of them is independent."""
    return any(within(wilson(count / trials, part * trials, confidence), bounds) for count in range(trials + 1))


def wilson(share: float, trials: float, confidence: float) -> tuple[float, float]:
    """Return the ends of the interval of a share [-] of independent trials (Wilson 1927)."""
    z = NormalDist().inv_cdf((1.0 + confidence) / 2.0)
    middle = share + z**2 / (2.0 * trials)
    reach = z * sqrt(share * (1.0 - share) / trials + z**2 / (4.0 * trials**2))
    scale = 1.0 + z**2 / trials
    low = 0.0 if share == 0.0 else (middle - reach) / scale
    high = 1.0 if share == 1.0 else (middle + reach) / scale
    return low, high


def is_met_by_a_rate(bounds: Bounds, hours: float, confidence: float) -> bool:
    """Return whether a count of events may have the interval of its rate within bounds [1/h], of which the lower is 0.

    The best outcome is no event; its interval has a closed form (Garwood 1936).
    """
    return within((0.0, -log((1.0 - confidence) / 2.0) / hours), bounds)


def trials_of(catalogue: Catalogue, cell: Cell) -> int | None:
    """Return of how many trials a cell is a share at the chosen scale; None where it is no share of a known number."""
    settings = catalogue.settings
    where = cell.where
    if cell.metric == DIVERGED:
        limbs = catalogue.all_methods[str(cell.method)].limbs
        experiment = catalogue.network(str(cell.method), limbs[0]).experiment
        on_robot = settings.sizes.robots.get(experiment)
        seeds = on_robot.seeds if on_robot else None
        return len(seeds or settings.sizes.experiments[experiment].seeds)
    if cell.table == "latency":
        return settings.evaluation.latency.stretches
    if cell.table in ("table_09", "found_by_rate") and where.get("quantity") == "found":
        return robots_of(settings) * shards_of(settings) * hits_of(settings, where["leg"], where["cell"])
    if cell.table == "safety" and where.get("measure") == "falls":
        ours = settings.reaction.ours
        reactions = settings.sizes.reactions
        sizes = reactions.cases.get(where["case"], reactions.pushed)
        is_ours = (where["detector"], where["thresholds"]) == (ours.detector, ours.rule)
        return robots_of(settings) * (sizes.runs if is_ours else min(sizes.compared, sizes.runs))
    return None


def hours_of(settings: Settings, cell: Cell) -> float | None:
    """Return in how much walking a cell counts events at most, at the chosen scale [h]; None where it counts none."""
    if cell.table == "sensorless" and cell.where.get("event") == "falls":
        sizes = settings.sizes.reactions.free
        return robots_of(settings) * sizes.runs * sizes.longest_s / HOUR_S
    if cell.table == "hourly":
        tests = [settings.evaluation.changed.tests[title] for title in settings.evaluation.hourly.known]
        walked_s = sum(settings.test_s(test.scenario) * len(test.limbs) for test in tests)
        return robots_of(settings) * shards_of(settings) * walked_s / HOUR_S
    return None


def robots_of(settings: Settings) -> int:
    """Return how many surrogate robots the chosen scale has."""
    return settings.sizes.fleet or len(settings.fleet.robots)


def shards_of(settings: Settings) -> int:
    """Return how many recordings of a test a surrogate robot makes at the chosen scale."""
    return settings.sizes.fleet_shards or settings.sizes.test.shards


def hits_of(settings: Settings, leg: str, cell: str) -> int:
    """Return how many collisions of a leg one recording has, in a cell, `<link> <direction>`, or in all of them."""
    detection = settings.detection
    side = next(side for side, limb in settings.layout.legs.items() if limb == leg)
    names = settings.scenarios[detection.collisions].pushes
    pushes = [settings.pushes[name] for name in names]
    points = None if cell == "all" else {f"{side}_{cell.replace(' ', '_')}"}
    own = [push for push in pushes if (push.point or "").startswith(f"{side}_")]
    struck = [push for push in own if points is None or push.point in points]
    walked_s = settings.test_s(detection.collisions)
    moments = chain.from_iterable(push.at_s or () for push in struck)
    return sum(moment < walked_s for moment in moments)
