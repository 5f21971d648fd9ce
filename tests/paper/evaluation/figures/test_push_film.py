"""The film of a push: its length and size, and that what it tells is what the files hold."""

import hashlib
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from csv_files import read_table, write_rows
from made_detections import SEED
from made_swings import GROUND, RATE_HZ, swinging, unseen
from PIL import Image

from experiments.evaluation.figures.drawing.push_film import eased, lines_of, push_film, shots_of
from experiments.evaluation.measure.estimates.felt import PushResponse
from experiments.evaluation.measure.push_scene import PushAlarm, read_story
from experiments.plan.runs import Run
from experiments.records.collisions import Collision, Detected
from experiments.settings.pages import PushFilm, Story
from experiments.settings.settings import Settings
from mobnet.core.columns import residual_columns, torque_columns
from mobnet.core.detections import COLLISION
from mobnet.core.errors import DataError
from mobnet.core.recording import Recording
from mobnet.core.recording_file import write_recording
from mobnet.core.store import write_array
from mobnet.kernel.low_pass import low_pass

START, LENGTH, PEAK_N, PEAK_NM, GAIN_HZ = GROUND + 150, 80, 150.0, 50.0, 100.0
SHARES = {"MOB": 1.5, "MOB-fric-dahl": 1.0, "MOB-Net-pushed": 0.7}  # of the push in each estimate
OFFSETS_NM = {"MOB": 20.0, "MOB-fric-dahl": 10.0, "MOB-Net-pushed": 3.0}  # errors that never change
DELAY_S = 0.035
Made = tuple[Story, list[Run], dict[str, dict[str, Path]]]


@pytest.fixture
def made(settings: Settings, tmp_path: Path) -> Made:
    """A walk with one push, estimates with known shares of it, and what the detector says."""
    layout, sensed = settings.layout, swinging(settings.layout, 1)
    rows, shorter = len(sensed), {"before_s": 0.3, "after_s": 0.4, "settle_s": 0.1}
    story = settings.evaluation.story.model_copy(update=shorter)
    wave = np.zeros(rows)
    wave[START : START + LENGTH] = np.sin(np.pi * (np.arange(LENGTH) + 0.5) / LENGTH)
    push, torque = np.zeros((rows, 4)), np.zeros((rows, layout.nv))
    push[:, 0], push[:, 1] = wave > 0, -PEAK_N * wave
    torque[:, layout.columns([story.joint])] = PEAK_NM * wave[:, None]
    truth = replace(unseen(layout, rows, push), tau_ext=torque, tau_push=torque, pushed=(wave > 0.0)[:, None])
    stem = tmp_path / "recordings" / f"s{SEED}"
    write_recording(stem, Recording(sensed, ((0, rows),), RATE_HZ, {}, truth), layout)
    behind, note = low_pass(torque, GAIN_HZ, RATE_HZ), {"rate_hz": RATE_HZ, "gain_hz": GAIN_HZ}
    write_array(tmp_path / "residual", np.concatenate([behind, behind], axis=1), residual_columns(layout), note)
    joints, runs = layout.limb("LL"), []
    for method, share in SHARES.items():
        own = share * behind[:, layout.columns(joints)] + OFFSETS_NM[method]
        columns = torque_columns(layout, ["tau_ext", "std"], joints)
        write_array(tmp_path / method, np.concatenate([own, np.full(own.shape, 4.0)], axis=1), columns, note)
        runs.append(Run(story.scenario, story.level, method, 0, SEED, stem, tmp_path / "residual", tmp_path / method))
    times = START / RATE_HZ, (START + 3) / RATE_HZ, (START + LENGTH) / RATE_HZ
    hit = Collision(story.scenario, SEED, 1, story.push, "LL", "knee", "front", *times, PEAK_N, 7.6, 0.4)
    said = Detected(story.scenario, SEED, "LL", 1, story.detector, COLLISION, 3.0, DELAY_S, None, "ratio.LL3", "knee",
                    "front", 100.0)  # fmt: skip
    files = {name: tmp_path / f"{name}.csv" for name in ("collisions", "detected")}
    write_rows(files["collisions"], [hit], Collision)
    write_rows(files["detected"], [said], Detected)
    return story, runs, {story.level: files}


def short(settings: Settings) -> PushFilm:
    """Return the film with few frames."""
    few = {"frames_hz": 5.0, "slowed_hz": 5.0, "slower": 2.0, "slow_s": (-0.05, 0.15), "hold_s": 0.5}
    return settings.evaluation.push_film.model_copy(update=few)


def test_shares_delays_and_errors_are_those_of_the_estimates(settings: Settings, made: Made) -> None:
    story, runs, detections = made
    hit, push = read_story(story, settings.layout, runs, detections[story.level], COLLISION)
    torques = push.torques(story.joint)
    felt = {method: push.felt(torque, story.joint, settings.evaluation.peaks) for method, torque in torques.items()}
    assert {method: own.share for method, own in felt.items()} == pytest.approx(SHARES, abs=1e-3)
    errors_nm = {method: push.error_nm(torque, story.joint) for method, torque in torques.items()}
    assert errors_nm["MOB-fric-dahl"] == pytest.approx(OFFSETS_NM["MOB-fric-dahl"], rel=1e-3)
    late = [felt[method].delay_ms for method in ("MOB", "MOB-fric-dahl", "MOB-Net-pushed")]
    assert late == sorted(late)  # a lower one reaches half of the peak later
    assert (push.time_s[0], push.time_s[-1]) == pytest.approx((-0.3, 0.399))
    assert np.linalg.norm(push.force, axis=1).max() == pytest.approx(PEAK_N, rel=0.01)
    assert (push.first + push.start, push.end - push.start) == (START, LENGTH)
    assert (hit.link, push.alarm) == ("knee", PushAlarm(DELAY_S, "knee", "front"))


def test_a_run_without_the_push_is_refused(settings: Settings, made: Made) -> None:
    story = made[0].model_copy(update={"push": "collision_left_foot_front"})
    with pytest.raises(DataError, match="'collision_left_foot_front' is not accepted"):
        read_story(story, settings.layout, made[1], made[2][story.level], COLLISION)


def test_a_push_of_which_nothing_is_said_is_refused(settings: Settings, made: Made) -> None:
    story, runs, detections = made
    with pytest.raises(DataError, match=r"detected\.csv: MOB-Net-pushed-ratio says nothing of push 1 of s"):
        read_story(story, settings.layout, runs, detections[story.level], "other")


def test_the_film_lasts_ten_seconds_and_slows_the_push(settings: Settings) -> None:
    section, story = settings.evaluation.push_film, settings.evaluation.story
    shots = shots_of(section, story)
    assert section.answer_s + sum(shot.seen_s for shot in shots) == pytest.approx(10.0, abs=2.0 / section.frames_hz)
    times = [shot.time_s for shot in shots]
    assert times == sorted(times)
    assert (times[0], times[-1]) == pytest.approx((-story.before_s, story.after_s), abs=2.0 / section.frames_hz)
    slowed = [shot for shot in shots if shot.slowed]
    assert min(shot.time_s for shot in slowed) < 0.0 < 0.09 < max(shot.time_s for shot in slowed)
    assert np.diff([shot.time_s for shot in slowed[:-1]]) * section.slower == pytest.approx(1.0 / section.slowed_hz)
    assert [shot.told for shot in shots] == [shot.time_s >= section.slow_s[1] for shot in shots]
    assert all(shot.ends_s[0] <= shot.time_s <= shot.ends_s[1] for shot in shots)


def test_the_time_axis_changes_without_a_jump() -> None:
    steps = [eased((0.0, 4.0), (1.0, 2.0), k) for k in range(30)]
    assert (steps[0], steps[-1]) == ((0.0, 4.0), (1.0, 2.0))
    assert np.abs(np.diff(steps, axis=0)).max() < 0.5


def test_the_lines_at_the_end_have_the_numbers_of_each_method() -> None:
    felt = {
        "MOB": PushResponse(98.0, 1.504, 2.0),
        "FTS-e2e": PushResponse(20.0, 0.3, None),
        "MOB-Net-pushed": PushResponse(43.0, 0.72, 24.7),
    }
    heads, *lines = lines_of(felt, {"MOB": 27.8, "FTS-e2e": 5.4, "MOB-Net-pushed": 3.9})
    assert lines == [
        ("MOB-Net-pushed", "72 %", "25 ms", "4 N m"),
        ("FTS-e2e", "30 %", "-", "5 N m"),
        ("MOB", "150 %", "2 ms", "28 N m"),
    ]
    assert len(heads) == len(lines[0])


def test_the_film_and_its_still_are_equal_for_equal_files_and_small(
    settings: Settings, made: Made, tmp_path: Path
) -> None:
    (story, runs, detections), whole, hashes = made, settings.evaluation, []
    for name in ("first", "second"):
        out = tmp_path / name / "push.webp"
        push_film(short(settings), story, whole.peaks, settings.robot, settings.robot.looks, settings.layout, runs,
                  detections, out)  # fmt: skip
        hashes.append([hashlib.sha256(path.read_bytes()).hexdigest() for path in sorted(out.parent.iterdir())])
    assert hashes[0] == hashes[1]
    assert sorted(path.name for path in out.parent.iterdir()) == ["push.csv", "push.gif", "push.png", "push.webp"]
    assert [row.method for row in read_table(out.with_suffix(".csv"))] == list(SHARES)
    with Image.open(out) as film:
        assert film.size == (960, 540)
        shown = sum(_durations(film))
    section = short(settings)
    seen_s = section.answer_s + sum(shot.seen_s for shot in shots_of(section, story))
    assert shown == pytest.approx(1000.0 * seen_s, abs=10.0)
    with Image.open(out.with_suffix(".png")) as still:
        assert np.asarray(still.convert("RGB")).std() > 10.0
    assert_begins_with_the_still(out)


def assert_begins_with_the_still(film: Path) -> None:
    """Check that the first frame of a film is its still, but for the palette, and that the second is another one."""
    with Image.open(film.with_suffix(".png")) as image:
        still = np.asarray(image.convert("RGB"), dtype=float)
    with Image.open(film) as frames:
        first = np.asarray(frames.convert("RGB"), dtype=float)
        frames.seek(1)
        second = np.asarray(frames.convert("RGB"), dtype=float)
    assert np.abs(first - still).mean() < 2.0 < np.abs(second - still).mean()


def _durations(film: Image.Image) -> list[float]:
    """Return how long each frame of a film is shown [ms]."""
    found = []
    for k in range(film.n_frames):
        film.seek(k)
        film.load()
        found.append(film.info["duration"])
    return found


def test_the_published_film_is_as_small_as_a_page_may_ask_for() -> None:
    published = Path(__file__).parents[4] / "docs/results/push.webp"
    assert published.stat().st_size < 2_000_000
    with Image.open(published) as film:
        assert film.size == (960, 540)
        assert sum(_durations(film)) == pytest.approx(10_000.0, abs=200.0)
    assert_begins_with_the_still(published)


def test_a_story_begins_and_ends_with_its_recording(settings: Settings, made: Made) -> None:
    story, runs, detections = made
    longer = story.model_copy(update={"before_s": 9.0, "after_s": 9.0})
    _, push = read_story(longer, settings.layout, runs, detections[story.level], COLLISION)
    rows = len(swinging(settings.layout, 1))
    assert (push.first, len(push.force)) == (0, rows)
    assert (push.first + push.start, push.end - push.start) == (START, LENGTH)
