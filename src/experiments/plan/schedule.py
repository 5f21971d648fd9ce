"""How long jobs take that wait for each other, for a core and for a GPU."""

import heapq
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from experiments.plan.dry_run import PlannedJob


@dataclass(frozen=True)
class TimedJob:
    """A job with the time that it takes [s], and whether it needs a GPU for itself all the while."""

    job: PlannedJob
    seconds: float
    gpu: bool = False


def elapsed_s(jobs: Sequence[TimedJob], cores: int, gpus: int = 0) -> float:
    """Return the time from the first start to the last end [s].

    Each job runs on a core when all that it reads is made; of those that can start, the one with the highest priority
    goes first, as Snakemake has it, and among equals the longest.
    """
    jobs = sorted(jobs, key=lambda own: own.job.name)  # a dry run tells its jobs in any order
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
        own = jobs[place]
        heapq.heappush(ready[own.gpu], (-own.job.priority, -own.seconds, place))

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
            heapq.heappush(running, (now + jobs[place].seconds, place))
        if not running:
            return now
        now, place = heapq.heappop(running)
        free[False] += 1
        free[True] += int(jobs[place].gpu)
        for after in followers[place]:
            left[after] -= 1
            if not left[after]:
                enqueue(after)


def _waits(jobs: Sequence[TimedJob]) -> Mapping[int, set[int]]:
    """Return the places of the jobs for which each job waits."""
    makers: dict[str, int] = {}
    for place, own in enumerate(jobs):
        makers |= dict.fromkeys(filter(None, own.job.outputs), place)
    return {place: {makers[name] for name in own.job.inputs if name in makers} for place, own in enumerate(jobs)}
