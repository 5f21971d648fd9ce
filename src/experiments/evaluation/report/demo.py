"""What `./reproduce demo` says and draws of the stored push."""

from collections.abc import Iterator
from pathlib import Path

from experiments.evaluation.compare.curves import TorqueCurve
from experiments.evaluation.measure.push_scene import PushScene
from experiments.evaluation.measure.story import StoredPush

MS = 1000.0
NAME_WIDTH = 20  # of names in the lines, those of detectors included


def title_of(stored: StoredPush) -> str:
    """Return which push it is."""
    hit = stored.collision
    story = stored.story
    where = f"{story.level} walks and is pushed on the {hit.direction} of the {hit.link} of its leg {hit.leg}"
    return f"{where}: {hit.force_n:.0f} N, {MS * (hit.end_s - hit.start_s):.0f} ms. Joint {story.joint}:"


def lines_of(stored: StoredPush, push: PushScene) -> Iterator[str]:
    """Yield a line for each method, and one for the detector."""
    for method, (shown, error) in _notes(stored, push).items():
        yield f"{method:<{NAME_WIDTH}} {shown}; {error}"
    said = "no alarm" if push.alarm is None else f"alarm {MS * push.alarm.delay_s:.0f} ms after the push begins"
    yield f"{stored.story.detector:<{NAME_WIDTH}} {said}"


def draw(stored: StoredPush, push: PushScene, out: Path) -> None:
    """Write the picture of what methods make of the push, PNG, PDF or SVG.

    Raises:
        DataError: it cannot be written.
    """
    # Matplotlib takes a second to import, which estimators do without.
    from experiments.evaluation.figures.drawing.felt import FeltPush, save_felt

    joint = stored.story.joint
    k = push.joints.index(joint)
    rows = slice(push.settled, None)
    peaks = stored.settings.evaluation.peaks
    stds = {method: std[rows, k] for method, std in push.stds.items()}
    curves = [TorqueCurve(method, torque[rows], stds.get(method)) for method, torque in push.torques(joint).items()]
    duration_s = stored.collision.end_s - stored.collision.start_s
    felt = FeltPush(
        joint=joint,
        time=push.time_s[rows],
        truth=push.truth[rows, k],
        estimates=curves,
        notes=_notes(stored, push),
        flags={"swing": push.flags["swing"][rows], "push": push.flags["pushed"][rows]},
        alarm_s=None if push.alarm is None else push.alarm.delay_s,
        detector=stored.story.detector,
        close_s=(-peaks.before_s, duration_s + peaks.after_s),
    )
    save_felt(felt, out)


def _notes(stored: StoredPush, push: PushScene) -> dict[str, tuple[str, str]]:
    """Return method -> what its estimate shows of the push, and how large its error is, in words."""
    joint = stored.story.joint
    seconds = push.time_s[-1] - push.time_s[push.settled]
    notes: dict[str, tuple[str, str]] = {}
    for method, torque in push.torques(joint).items():
        felt = push.felt(torque, joint, stored.settings.evaluation.peaks)
        shown = f"{felt.share:.0%} of the push's peak, {_late(felt.delay_ms)}"
        notes[method] = (shown, f"RMSE {push.error_nm(torque, joint):.1f} N m over {seconds:.1f} s")
    return notes


def _late(delay_ms: float | None) -> str:
    """Return a delay in words."""
    return "never half of it" if delay_ms is None else f"{delay_ms:.0f} ms late"
