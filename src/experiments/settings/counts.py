"""How many trials, or hours of walking, stand behind the counts in a product's table at the chosen scale.

With them a claim about a count is refused before it has a result, where no result could meet it.
"""

from collections.abc import Callable, Mapping
from itertools import chain

from experiments.settings.claims import Cell
from experiments.settings.settings import Settings

HOUR_S = 3600.0


def stretches(settings: Settings, _: Cell) -> int:
    """Return in how many stretches of ticks the time of a tick is measured."""
    return settings.evaluation.latency.stretches


def collisions(settings: Settings, cell: Cell) -> int | None:
    """Return of how many collisions a cell says the found share."""
    where = cell.where
    if where.get("quantity") != "found" or not {"leg", "cell"} <= where.keys():
        return None
    hits = hits_of(settings, where["leg"], where["cell"])
    return robots_of(settings) * shards_of(settings) * hits or None


def pushed_walks(settings: Settings, cell: Cell) -> int | None:
    """Return of how many walks into something a cell says the share that falls."""
    where = cell.where
    if where.get("measure") != "falls" or not {"case", "detector", "thresholds"} <= where.keys():
        return None
    ours = settings.reaction.ours
    reactions = settings.sizes.reactions
    sizes = reactions.cases.get(where["case"], reactions.pushed)
    is_ours = (where["detector"], where["thresholds"]) == (ours.detector, ours.rule)
    return robots_of(settings) * (sizes.runs if is_ours else min(sizes.compared, sizes.runs))


def free_walk_hours(settings: Settings, cell: Cell) -> float | None:
    """Return in how much walking that nothing stands in the way of a cell counts falls at most [h]."""
    if cell.where.get("event") != "falls":
        return None
    sizes = settings.sizes.reactions.free
    return robots_of(settings) * sizes.runs * sizes.longest_s / HOUR_S


def known_hours(settings: Settings, _: Cell) -> float:
    """Return in how much walking of robots that the networks know a cell counts flags at most, leg by leg [h]."""
    tests = [settings.evaluation.changed.tests[title] for title in settings.evaluation.hourly.known]
    walked_s = sum(settings.test_s(test.scenario) * len(test.limbs) for test in tests)
    return robots_of(settings) * shards_of(settings) * walked_s / HOUR_S


def robots_of(settings: Settings) -> int:
    """Return how many surrogate robots of the chosen scale walk all tests."""
    sizes = settings.sizes
    return sizes.fleet_whole or sizes.fleet or len(settings.fleet.robots)


def shards_of(settings: Settings) -> int:
    """Return how many recordings of a test a surrogate robot makes at the chosen scale."""
    return settings.sizes.fleet_shards or settings.sizes.test.shards


def hits_of(settings: Settings, leg: str, cell: str) -> int:
    """Return how many collisions of a leg one recording has, in a cell, `<link> <direction>`, or in all of them."""
    detection = settings.detection
    side = next((side for side, limb in settings.layout.legs.items() if limb == leg), "no side")
    names = settings.scenarios[detection.collisions].pushes
    pushes = [settings.pushes[name] for name in names]
    points = None if cell == "all" else {f"{side}_{cell.replace(' ', '_')}"}
    of_leg = [push for push in pushes if (push.point or "").startswith(f"{side}_")]
    struck = [push for push in of_leg if points is None or push.point in points]
    walked_s = settings.test_s(detection.collisions)
    moments = chain.from_iterable(push.at_s or () for push in struck)
    return sum(moment < walked_s for moment in moments)


# Product -> of how many trials a cell of its table is a share; None where it is no share of a known number.
TRIALS: Mapping[str, Callable[[Settings, Cell], int | None]] = {
    "table_09": collisions,
    "safety": pushed_walks,
    "found_by_rate": collisions,
    "latency": stretches,
}
# Product -> in how much walking a cell counts events at most [h]; None where it counts none.
HOURS: Mapping[str, Callable[[Settings, Cell], float | None]] = {
    "hourly": known_hours,
    "sensorless": free_walk_hours,
}
