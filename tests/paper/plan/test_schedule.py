"""Jobs start when what they read is made, on a core of their own and, if they need it, on a GPU."""

import pytest

from experiments.plan.dry_run import PlannedJob
from experiments.plan.schedule import TimedJob, elapsed_s, most_held


def timed(name: str, seconds: float, reads: tuple[str, ...] = (), *, gpu: bool = False, priority: int = 0) -> TimedJob:
    """Return a job that makes the file of its name."""
    return TimedJob(PlannedJob("made", name, {}, (name,), {}, reads, priority), seconds, gpu)


FORK = (timed("a", 3.0), timed("b", 2.0), timed("c", 2.0), timed("end", 1.0, ("a", "b", "c", "a file that is there")))


@pytest.mark.parametrize(("cores", "elapsed"), [(1, 8.0), (2, 5.0), (3, 4.0), (100, 4.0)])
def test_jobs_wait_for_cores_and_for_what_they_read(cores: int, elapsed: float) -> None:
    assert elapsed_s(FORK, cores) == elapsed


def test_jobs_of_a_gpu_wait_for_it_and_hold_a_core() -> None:
    jobs = [timed("a", 2.0, gpu=True), timed("b", 2.0, gpu=True), timed("c", 4.0)]
    assert elapsed_s(jobs, 2, gpus=1) == 4.0
    assert elapsed_s(jobs, 3, gpus=2) == 4.0
    assert elapsed_s(jobs[:2], 8, gpus=1) == 4.0
    assert elapsed_s(jobs[:2], 8, gpus=2) == 2.0
    assert elapsed_s(jobs, 1, gpus=2) == 8.0


def test_a_job_of_higher_priority_goes_first() -> None:
    """Else its follower would wait."""
    jobs = [timed("long", 2.0), timed("first", 1.0, priority=20), timed("then", 2.0, ("first",))]
    assert elapsed_s(jobs, 1) == 5.0
    assert elapsed_s(jobs, 2) == 3.0


def test_nothing_takes_no_time() -> None:
    assert elapsed_s([], 2) == 0.0


def test_the_order_in_which_jobs_are_told_has_no_part_in_it() -> None:
    jobs = [timed(name, 1.0) for name in "abc"] + [timed("end", 3.0, ("a",))]
    assert elapsed_s(jobs, 2) == elapsed_s(jobs[::-1], 2) == 4.0


def test_what_is_held_at_most_is_a_running_maximum() -> None:
    """After the first two jobs their files go, and what is left is less than what was there."""
    jobs = [timed("a", 1.0), timed("b", 1.0, ("a",)), timed("c", 1.0, ("b",))]
    size = {"a": 3.0, "b": 4.0, "c": 1.0}
    assert most_held(jobs, 1, lambda job: size[job.name], lambda job: True) == 7.0
    assert most_held(jobs, 1, lambda job: size[job.name], lambda job: False) == 8.0
    assert most_held([], 1, lambda job: size[job.name], lambda job: True) == 0.0
