"""The stored push gives the estimates of the published run, and `./reproduce demo` tells and draws what they show."""

import os
import re
import shutil
import subprocess
import sys
from collections.abc import Mapping
from pathlib import Path

import numpy as np
import pytest
from paper_settings import settings_at

from experiments.demo import DATA, load, main
from experiments.evaluation.measure.estimates.felt import PushResponse
from experiments.evaluation.measure.push_scene import PushScene
from experiments.evaluation.measure.story import StoredPush
from experiments.evaluation.number.rows import read_detections
from experiments.evaluation.report.demo import draw, lines_of, title_of
from experiments.evaluation.report.manifest import file_hash
from experiments.plan.demo import SOURCES, estimate_place
from experiments.site.snapshot import tell_demo
from mobnet.core.columns import EXTERNAL, STD, named
from mobnet.core.errors import ConfigError, DataError
from mobnet.core.estimator import Estimate
from mobnet.core.files import read_json
from mobnet.core.store import read_array
from mobnet.kernel.low_pass import low_pass

REPO = Path(__file__).parents[4]
PAGE = (REPO / "docs" / "demo.md").read_text()
EVALUATION = settings_at().evaluation
METHODS = EVALUATION.story.methods
SETTLED_NM, AFTER_NM = 0.002, 0.0004  # bounds of differences once estimators are judged, and from the push on
READ = (
    "recording.json", "recording.parquet", "collisions.csv", "thresholds.csv", "fits/MOB-fric-dahl.json",
    "networks/MOB-Net-pushed-LL/weights.safetensors",
)  # fmt: skip
Estimates = Mapping[str, Estimate]


@pytest.fixture(scope="module")
def stored() -> StoredPush:
    return StoredPush(DATA, settings_at())


@pytest.fixture(scope="module")
def estimates(stored: StoredPush) -> Estimates:
    """What each method makes of the stored push, step by step."""
    return {method: stored.estimate(method) for method in METHODS}


@pytest.fixture(scope="module")
def push(stored: StoredPush, estimates: Estimates) -> PushScene:
    return stored.scene(estimates)


@pytest.mark.parametrize("method", METHODS)
def test_what_is_stored_makes_the_estimates_of_the_published_run(
    push: PushScene, estimates: Estimates, method: str
) -> None:
    """Those began at the beginning of the walk, ours begin a little before the push."""
    ours, made = estimates[method], DATA / estimate_place(method)
    signals = {EXTERNAL: ours.tau_ext} | ({} if ours.std is None else {STD: ours.std})
    assert (STD in signals) == (method == "MOB-Net-pushed")
    for signal, values in signals.items():
        run, _ = read_array(made, named(signal, push.joints))
        assert np.abs(values - run)[push.settled :].max() < SETTLED_NM
        assert np.abs(values - run)[push.start :].max() < AFTER_NM
        assert np.abs(run[push.settled :]).max() > 1.0


def test_what_was_copied_has_the_hash_that_is_noted_and_is_of_the_published_run() -> None:
    note, published = read_json(DATA / SOURCES), read_json(REPO / "docs" / "results" / "provenance.json")
    sources = note["sources"]
    copied = [name for name in sources if name.startswith(("networks", "fits"))]
    assert len(copied) == 3
    assert [name for name in copied if file_hash(DATA / name) != sources[name]["sha256"]] == []
    assert note["scale"] == published["scale"]
    assert sources["recording.parquet"]["commit"] == read_json(DATA / "recording.json")["provenance"]["commit"]
    weights = sources["networks/MOB-Net-pushed-LL/weights.safetensors"]
    assert weights["commit"] == read_json(DATA / "networks/MOB-Net-pushed-LL/run.json")["provenance"]["commit"]


def test_the_stored_push_is_small() -> None:
    assert sum(path.stat().st_size for path in DATA.rglob("*")) < 5e6


def test_the_window_begins_before_the_push_as_long_as_the_story_says(stored: StoredPush, push: PushScene) -> None:
    pushed = push.flags["pushed"]
    assert (np.flatnonzero(pushed)[0], np.flatnonzero(pushed)[-1] + 1) == (push.start, push.end)
    assert (push.time_s[0], push.time_s[-1]) == (-stored.story.before_s, stored.story.after_s - 0.001)
    assert push.flags["swing"][pushed].all()


def felt(push: PushScene, torque: np.ndarray) -> PushResponse:
    """Return what a torque shows of the push at the joint of the story."""
    return push.felt(torque, EVALUATION.story.joint, EVALUATION.peaks)


@pytest.fixture
def truth(stored: StoredPush, push: PushScene) -> np.ndarray:
    """The true torque of the joint of the story."""
    return push.truth[:, push.joints.index(stored.story.joint)]


def test_a_perfect_estimate_shows_the_whole_push(push: PushScene, truth: np.ndarray) -> None:
    found = felt(push, truth)
    assert found.share == pytest.approx(1.0)
    assert found.delay_ms is not None
    assert 0.0 < found.delay_ms < 15.0  # the observer's low-pass, of 10 ms
    assert push.error_nm(truth, "LL3") == 0.0


def test_a_constant_error_changes_the_rmse_alone(push: PushScene, truth: np.ndarray) -> None:
    found, off = felt(push, truth), felt(push, truth + 3.0)
    assert (off.share, off.delay_ms) == (pytest.approx(found.share), pytest.approx(found.delay_ms))
    assert push.error_nm(truth + 3.0, "LL3") == pytest.approx(3.0)


@pytest.mark.parametrize("part", [0.0, 0.5, 2.0])
def test_a_part_of_the_push_is_a_share_of_its_peak(push: PushScene, truth: np.ndarray, part: float) -> None:
    behind = low_pass(push.push[:, push.joints.index("LL3")], push.gain_hz, push.rate_hz)
    found = felt(push, truth - (1.0 - part) * behind)
    assert found.share == pytest.approx(part, abs=1e-6)
    assert (found.delay_ms is None) == (part <= 0.5)  # behind the low-pass the peak is a little lower


def test_a_late_estimate_is_late(push: PushScene, truth: np.ndarray) -> None:
    late, prompt = felt(push, np.roll(truth, 20)), felt(push, truth)
    assert late.delay_ms is not None
    assert late.delay_ms - 20.0 == pytest.approx(prompt.delay_ms, abs=1.0)


def test_the_alarm_is_that_of_the_published_run(stored: StoredPush, push: PushScene) -> None:
    (detected,) = read_detections(DATA / "detected.csv", "detected")
    assert (detected.detector, detected.number) == (stored.story.detector, stored.collision.number)
    assert (None if push.alarm is None else push.alarm.delay_s) == pytest.approx(detected.delay_s)


def test_thresholds_of_half_the_size_raise_an_alarm_that_is_told_and_drawn(
    tmp_path: Path, estimates: Estimates, push: PushScene
) -> None:
    """So that the alarm is tested whether or not the push of the published run raises one."""
    path = shutil.copytree(DATA, tmp_path / "data") / "thresholds.csv"
    head, *rows = path.read_text().splitlines()
    halved: list[str] = []
    for row in rows:
        *place, value, unit = row.split(",")
        halved.append(",".join([*place, str(float(value) / 2.0), unit]))
    path.write_text("\n".join([head, *halved, ""]))
    sensitive = StoredPush(tmp_path / "data", settings_at())
    scene = sensitive.scene(estimates)
    assert scene.alarm is not None
    assert 0.0 < scene.alarm.delay_s < (push.end - push.start) / push.rate_hz + 0.1
    (*_, line) = lines_of(sensitive, scene)
    assert line.endswith(f"alarm {1000 * scene.alarm.delay_s:.0f} ms after the push begins")
    draw(sensitive, scene, tmp_path / "alarm.svg")
    assert sensitive.story.detector in (tmp_path / "alarm.svg").read_text()


def test_nothing_felt_is_no_alarm(stored: StoredPush, push: PushScene) -> None:
    nothing = Estimate(np.zeros(push.truth.shape), np.ones(push.truth.shape))
    calm = stored.scene(dict.fromkeys(METHODS, nothing))
    assert calm.alarm is None
    lines = list(lines_of(stored, calm))
    assert lines[-1].endswith("no alarm")
    assert all("never half of it" in line for line in lines[:-1])


def test_the_page_says_what_the_command_prints_and_the_picture_is_drawn_alike(
    stored: StoredPush, push: PushScene, tmp_path: Path
) -> None:
    (block,) = re.findall(r"<!-- demo -->\n```\n(.*?)\n```\n<!-- /demo -->", PAGE, re.DOTALL)
    assert block.splitlines() == [title_of(stored), *lines_of(stored, push)]
    for ending in ("png", "svg"):
        drawn = [tmp_path / f"{name}.{ending}" for name in ("a", "b")]
        for out in (*drawn, drawn[0]):
            draw(stored, push, out)
        assert drawn[0].read_bytes() == drawn[1].read_bytes()
    text = (tmp_path / "a.svg").read_text()
    assert all(method in text for method in METHODS)
    assert (stored.story.detector in text) == (push.alarm is not None)
    assert len(list(tmp_path.iterdir())) == 4


def test_the_snapshot_renews_what_the_page_says(stored: StoredPush, tmp_path: Path) -> None:
    page = tmp_path / "demo.md"
    page.write_text(re.sub(r"```\nrobot_1.*?```", "old", PAGE, flags=re.DOTALL))
    assert page.read_text() != PAGE
    tell_demo(stored, page)
    assert page.read_text() == PAGE


def test_the_command_runs_without_torch_and_needs_nothing_but_the_stored_push(tmp_path: Path) -> None:
    data = shutil.copytree(DATA, tmp_path / "data", ignore=shutil.ignore_patterns("estimates", "detected.csv"))
    ends = "sys.exit(code or 'torch' in sys.modules)"
    code = f"import sys; from experiments.demo import main; code = main(sys.argv[1:]); {ends}"
    words = [sys.executable, "-c", code, "--data", str(data), "--out", "push.png"]
    done = subprocess.run(words, cwd=tmp_path, capture_output=True, text=True, check=True, env={**os.environ})
    lines = [line for line in done.stdout.splitlines() if not line.startswith("compiling")]
    assert [line.split()[0] for line in lines] == ["robot_1", *METHODS, "MOB-Net-pushed-ratio", "push.png"]
    assert (tmp_path / "push.png").read_bytes().startswith(b"\x89PNG")


@pytest.mark.parametrize("name", READ)
@pytest.mark.parametrize("kind", ["missing", "damaged"])
def test_a_missing_or_damaged_file_is_one_line(
    name: str, kind: str, tmp_path: Path, caplog: pytest.LogCaptureFixture, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("logging.basicConfig", lambda **_: None)
    path = shutil.copytree(DATA, tmp_path / "data") / name
    if kind == "missing":
        path.unlink()
    else:
        path.write_bytes(path.read_bytes()[: path.stat().st_size // 2])
    assert main(["--data", str(tmp_path / "data"), "--out", str(tmp_path / "push.png")]) == 1
    (error,) = [record.getMessage() for record in caplog.records if record.levelname == "ERROR"]
    assert path.stem in error
    assert "accepted" in error
    assert "\n" not in error
    assert not (tmp_path / "push.png").exists()


def test_thresholds_of_another_detector_are_told(tmp_path: Path, estimates: Estimates) -> None:
    path = shutil.copytree(DATA, tmp_path / "data") / "thresholds.csv"
    path.write_text(path.read_text().replace("ratio.LL3", "mean.LL3"))
    with pytest.raises(DataError, match=r"thresholds\.csv: threshold of ratio\.LL3, phase 1, is missing"):
        StoredPush(tmp_path / "data", settings_at()).scene(estimates)


def test_pictures_of_another_kind_are_refused(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit, match="2"):
        main(["--out", "push.bmp"])
    assert "--out: ending: '.bmp' is not accepted; accepted: .pdf, .png, .svg" in capsys.readouterr().err


def test_the_code_of_the_page_runs(capsys: pytest.CaptureFixture[str], stored: StoredPush) -> None:
    (code,) = re.findall(r"^```python\n(.*?)^```$", PAGE, flags=re.DOTALL | re.MULTILINE)
    assert len([line for line in code.splitlines() if line and not line.startswith("from")]) == 5
    found: dict[str, object] = {}
    exec(code, found)
    last = read_array(DATA / estimate_place("MOB-Net-pushed"), named(EXTERNAL, stored.joints))[0][-1]
    printed = eval(capsys.readouterr().out, {"np": np})
    assert list(printed) == list(stored.joints)
    np.testing.assert_allclose(list(printed.values()), last, atol=AFTER_NM)


@pytest.mark.parametrize("method", METHODS)
def test_every_method_can_be_loaded(method: str, stored: StoredPush) -> None:
    estimator, samples = load(method)
    state, estimate = estimator.step(estimator.init(), samples[0])
    assert state is not None
    assert set(stored.joints) <= set(estimator.joints)
    assert estimate.tau_ext.shape == (len(estimator.joints),)


def test_a_method_that_is_not_stored_is_named() -> None:
    with pytest.raises(
        ConfigError, match="method: 'FTS-e2e' is not accepted; accepted: MOB, MOB-Net-pushed, MOB-fric-dahl"
    ):
        load("FTS-e2e")


def test_numbers_of_the_page_are_those_of_the_story_and_of_the_samples(stored: StoredPush) -> None:
    story, sensed = stored.story, stored.recording.sensed
    assert f"begins {story.settle_s:g} s after" in PAGE.replace("\n", " ")
    assert f"less than {SETTLED_NM} N m" in PAGE
    assert f"`samples` are {story.before_s + story.after_s:g} s" in PAGE
    assert all(f"`{name}` ({getattr(sensed, name).shape[1]},)" in PAGE.replace("\n", " ") for name in "qv")
    assert f"`tau_motor` ({sensed.tau_motor.shape[1]},)" in PAGE
    assert f"`estimate.tau_ext` ({len(stored.joints)},)" in PAGE
