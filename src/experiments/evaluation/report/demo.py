"""What `./reproduce demo` says and draws of the stored push."""

from collections.abc import Iterator, Mapping
from pathlib import Path

from experiments.evaluation.compare.curves import TorqueCurve
from experiments.evaluation.measure.story import StoredPush
from mobnet.core.estimator import Estimate

MS = 1000.0
Estimates = Mapping[str, Estimate]  # method -> its estimate of the leg's joints


def title_of(push: StoredPush) -> str:
    """Return which push it is."""
    hit = push.collision
    story = push.story
    where = f"{story.level} walks and is pushed on the {hit.direction} of the {hit.link} of its leg {hit.leg}"
    return f"{where}: {hit.force_n:.0f} N, {MS * (hit.end_s - hit.start_s):.0f} ms. Joint {story.joint}:"


def lines_of(push: StoredPush, estimates: Estimates) -> Iterator[str]:
    """Yield a line for each method, and one for the detector."""
    for method, (shown, error) in _notes(push, estimates).items():
        yield f"{method:<14} {shown}; {error}"
    alarm_s = push.alarm_s(estimates)
    said = "no alarm" if alarm_s is None else f"alarm {MS * alarm_s:.0f} ms after the push begins"
    yield f"{push.story.detector:<14} {said}"


def draw(push: StoredPush, estimates: Estimates, out: Path) -> None:
    """Write the picture of what methods make of the push, PNG, PDF or SVG.

    Raises:
        DataError: it cannot be written.
    """
    # Matplotlib takes a second to import, which estimators do without.
    from experiments.evaluation.figures.drawing.felt import FeltPush, save_felt

    rows = push.settled
    k = push.place
    peaks = push.settings.evaluation.peaks
    curves = [
        TorqueCurve(method, one.tau_ext[rows, k], None if one.std is None else one.std[rows, k])
        for method, one in estimates.items()
    ]
    duration_s = push.collision.end_s - push.collision.start_s
    felt = FeltPush(
        joint=push.story.joint,
        time=push.time[rows],
        truth=push.truth[rows, k],
        estimates=curves,
        notes=_notes(push, estimates),
        flags={"swing": push.swing[rows], "push": push.pushed[rows]},
        alarm_s=push.alarm_s(estimates),
        detector=push.story.detector,
        close_s=(-peaks.before_s, duration_s + peaks.after_s),
    )
    save_felt(felt, out)


def _notes(push: StoredPush, estimates: Estimates) -> dict[str, tuple[str, str]]:
    """Return method -> what its estimate shows of the push, and how large its error is, in words."""
    seconds = push.time[-1] - push.time[push.settled][0]
    found = {method: push.felt(estimate) for method, estimate in estimates.items()}
    return {
        method: (
            f"{one.share:.0%} of the push's peak, {_late(one.delay_ms)}",
            f"RMSE {push.error_nm(estimates[method]):.1f} N m over {seconds:.1f} s",
        )
        for method, one in found.items()
    }


def _late(delay_ms: float | None) -> str:
    """Return a delay in words."""
    return "never half of it" if delay_ms is None else f"{delay_ms:.0f} ms late"
