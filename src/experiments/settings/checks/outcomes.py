"""What must hold for claims about counts: at a scale that decides them, some outcome of the run meets their bounds.

A share of few walks, or of the walks of few robots, has a long interval, so that a bound may be out of reach whatever
happens in them. The best outcome is that of robots that are alike (docs/notes/measures.md).
"""

from collections.abc import Iterator

from experiments.intervals.bounds import Bounds, within
from experiments.intervals.few_clusters import rate_ends, share_ends
from experiments.intervals.independent import garwood, wilson
from experiments.settings import counts
from experiments.settings.catalogue import Catalogue
from experiments.settings.claim_ranges import ranges_of
from experiments.settings.claims import Cell, Claim
from experiments.settings.evaluation import CLAIMED_TABLES
from experiments.settings.runs import Statistics
from experiments.settings.settings import Settings
from mobnet.core.errors import misfit
from mobnet.formats.reading import Problem

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
        statistics = settings.evaluation.statistics
        clusters = clusters_of(settings, cell)
        if trials is not None and not is_met_by_a_share(bounds, trials, clusters, statistics):
            text = f"a range that no share of {trials} reaches with its interval"
            yield _place(name, claim), misfit(text, f"a wider range, or more of them at scale {settings.scale}")
        if hours is not None and not is_met_by_a_rate(bounds, hours, clusters, statistics):
            text = f"a range that no count in {hours:.2f} h reaches with its interval"
            yield _place(name, claim), misfit(text, f"a wider range, or longer walks at scale {settings.scale}")


def _place(name: str, claim: Claim) -> tuple[str, ...]:
    return ("claims", name, "bar" if claim.bar else "rule")


def clusters_of(settings: Settings, cell: Cell) -> int:
    """Return in how many robots the trials of a cell come; 1 where they are independent, or of one robot."""
    table = CLAIMED_TABLES.get(cell.table or "")
    return counts.robots_of(settings) if table and table.clustered else 1


def is_met_by_a_share(bounds: Bounds, trials: int, clusters: int, statistics: Statistics) -> bool:
    """Return whether some share of so many trials, in clusters that are alike, has its interval within bounds [-]."""
    low, high = bounds
    # The likeliest to meet the bounds come first: none of them, all of them, or those in the middle of two bounds.
    if not low:
        first = 0.0
    elif high is None or high >= 1.0:
        first = 1.0
    else:
        first = (low + high) / 2.0
    counts = sorted(range(trials + 1), key=lambda count: abs(count / trials - first))
    return any(within(best_share(count, trials, clusters, statistics), bounds) for count in counts)


def best_share(count: int, trials: int, clusters: int, statistics: Statistics) -> tuple[float, float]:
    """Return the ends of the interval of a share [-] of so many trials in clusters that are alike."""
    if clusters == 1:
        return wilson(count / trials, trials, statistics.confidence)
    return share_ends(parts_of(count, clusters), parts_of(trials, clusters), statistics)


def parts_of(count: int, clusters: int) -> list[int]:
    """Return so many things in clusters that have as many each as can be."""
    return [count // clusters + (k < count % clusters) for k in range(clusters)]


def is_met_by_a_rate(bounds: Bounds, hours: float, clusters: int, statistics: Statistics) -> bool:
    """Return whether a count of events may have the interval of its rate within bounds [1/h], of which the lower is 0.

    The best outcome is no event.
    """
    if clusters == 1:
        low, high = garwood(0, statistics.confidence)
        return within((low / hours, high / hours), bounds)
    return within(rate_ends([0] * clusters, [hours / clusters] * clusters, statistics), bounds)


def trials_of(catalogue: Catalogue, cell: Cell) -> int | None:
    """Return of how many trials a cell is a share at the chosen scale; None where it is no share of a known number."""
    settings = catalogue.settings
    if cell.metric == DIVERGED:
        limbs = catalogue.all_methods[str(cell.method)].limbs
        experiment = catalogue.network(str(cell.method), limbs[0]).experiment
        on_robot = settings.sizes.robots.get(experiment)
        seeds = on_robot.seeds if on_robot else None
        return len(seeds or settings.sizes.experiments[experiment].seeds)
    count = counts.TRIALS.get(cell.table or "")
    return count(settings, cell) if count else None


def hours_of(settings: Settings, cell: Cell) -> float | None:
    """Return in how much walking a cell counts events at most, at the chosen scale [h]; None where it counts none."""
    count = counts.HOURS.get(cell.table or "")
    return count(settings, cell) if count else None
