"""How long jobs take that wait for each other, for a core and for a GPU."""

import heapq
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass

from experiments.plan.dry_run import PlannedJob


@dataclass(frozen=True)
class TimedJob:
    """A job with the time that it takes [s], and whether it needs a GPU for itself all the while."""

    job: PlannedJob
    seconds: float
    gpu: bool = False


def elapsed_s(jobs: Sequence[TimedJob], cores: int, gpus: int = 0) -> float:
    """Return the time from the first start to the last end [s]."""
    return max((now for now, _, _ in _course(in_order(jobs), cores, gpus)), default=0.0)


def most_held(
    jobs: Sequence[TimedJob], cores: int, size: Callable[[PlannedJob], float], is_let_go: Callable[[PlannedJob], bool]
) -> float:
    """Return the most that outputs take at once, where those of some jobs go when all that read them have ended.

    Args:
        jobs: those of a run.
        cores: on which they run.
        size: what the outputs of a job take.
        is_let_go: whether they go.
    """
    jobs = in_order(jobs)
    waits = _waits(jobs)
    readers = [0] * len(jobs)
    for before in waits.values():
        for earlier in before:
            readers[earlier] += 1
    now, most = 0.0, 0.0
    for _, place, begins in _course(jobs, cores, 0):
        if begins:
            now += size(jobs[place].job)
            most = max(most, now)
            continue
        for earlier in waits[place]:
            readers[earlier] -= 1
            if not readers[earlier] and is_let_go(jobs[earlier].job):
                now -= size(jobs[earlier].job)
    return most


def in_order(jobs: Sequence[TimedJob]) -> list[TimedJob]:
    """Return jobs by their names: a dry run tells them in any order."""
    return sorted(jobs, key=lambda timed: timed.job.name)


def _course(jobs: Sequence[TimedJob], cores: int, gpus: int) -> Iterator[tuple[float, int, bool]]:
    """Yield when a job begins or ends [s], its place among the jobs, and whether it begins.

    Each job runs on a core when all that it reads is made; of those that can start, the one with the highest priority
    goes first, as Snakemake has it, and among equals the longest.
    """
    waits = _waits(jobs)
    followers: list[list[int]] = [[] for _ in jobs]
    for place, before in waits.items():
        for earlier in before:
            followers[earlier].append(place)
    left = {place: len(before) for place, before in waits.items()}
    ready = {False: list[tuple[float, float, int]](), True: list[tuple[float, float, int]]()}
    free = {False: cores, True: gpus}
    running: list[tuple[float, int]] = []

    def enqueue(place: int) -> None:
        timed = jobs[place]
        heapq.heappush(ready[timed.gpu], (-timed.job.priority, -timed.seconds, place))

    for place, count in left.items():
        if not count:
            enqueue(place)
    now = 0.0
    while True:
        while free[False] and (kinds := [kind for kind, queue in ready.items() if queue and free[kind]]):
            chosen = min(kinds, key=lambda kind: ready[kind][0])
            _, _, place = heapq.heappop(ready[chosen])
            free[False] -= 1
            free[True] -= int(chosen)
            yield now, place, True
            heapq.heappush(running, (now + jobs[place].seconds, place))
        if not running:
            return
        now, place = heapq.heappop(running)
        yield now, place, False
        free[False] += 1
        free[True] += int(jobs[place].gpu)
        for after in followers[place]:
            left[after] -= 1
            if not left[after]:
                enqueue(after)


def _waits(jobs: Sequence[TimedJob]) -> Mapping[int, set[int]]:
    """Return the places of the jobs for which each job waits."""
    makers: dict[str, int] = {}
    for place, timed in enumerate(jobs):
        makers |= dict.fromkeys(filter(None, timed.job.outputs), place)
    return {place: {makers[name] for name in timed.job.inputs if name in makers} for place, timed in enumerate(jobs)}
