"""The command: what it makes, and one line for what it does not accept."""

import logging
import re
from pathlib import Path

import matplotlib.image
import pytest
from PIL import Image

from experiments import look as command
from mobnet.core.errors import DrawingError
from mobnet.simulation import render

ROOT = Path(__file__).parents[3]


@pytest.fixture(autouse=True)
def at_home(monkeypatch, caplog):
    """Run in the repository, without a display, and keep what is said."""
    monkeypatch.chdir(ROOT)
    monkeypatch.setattr(command, "has_display", lambda: False)
    caplog.set_level(logging.INFO)


@pytest.mark.slow
@pytest.mark.sim
def test_it_draws_a_walking_robot(tmp_path, caplog):
    clip, picture = tmp_path / "walk.gif", tmp_path / "walk.png"
    words = f"--seconds 1.2 --video {clip} --width 201 --picture {picture} --terrain plates"
    assert command.main(words.split()) == 0
    if "not drawn" in caplog.text:
        pytest.skip(caplog.messages[0])
    with Image.open(clip) as frames:
        assert (frames.n_frames, frames.size) == (16, (200, 150))
    assert matplotlib.image.imread(picture).shape[:2] == render.SIZE[::-1]
    assert "forward_walk, all_uncertainty, plates: " in caplog.messages[-1]


@pytest.mark.slow
@pytest.mark.sim
def test_undrawn_is_still_walked(tmp_path, monkeypatch, caplog):
    def refuse(*_):
        raise DrawingError("no drawing off screen")

    monkeypatch.setattr(command, "draw_frames", refuse)
    monkeypatch.setattr(command, "save_picture", refuse)
    words = ["--video", str(tmp_path / "walk.gif"), "--picture", str(tmp_path / "walk.png"), "--seconds", "0.5"]
    assert command.main(words) == 0
    assert caplog.messages[:2] == ["not drawn: no drawing off screen"] * 2
    assert not list(tmp_path.iterdir())
    walked = float(caplog.messages[2].split(" in ")[1].split(" s")[0])
    assert 0.5 <= walked <= 0.5 + command.LOOKED_FOR_S


@pytest.mark.slow
@pytest.mark.sim
@pytest.mark.parametrize(("words", "wanted"), [([], float("inf")), (["--seconds", "2"], 2.0)])
def test_the_viewer_opens_on_a_display(monkeypatch, words, wanted):
    watched = []
    monkeypatch.setattr(command, "has_display", lambda: True)
    monkeypatch.setattr(command, "watch", lambda simulator, seconds: watched.append(seconds))
    assert command.main(words) == 0
    assert watched == [wanted]


def test_ctrl_c_is_one_line(monkeypatch, caplog):
    def stop(_):
        raise KeyboardInterrupt

    monkeypatch.setattr(command, "load_settings", stop)
    assert command.main([]) == 130
    assert [len(message.splitlines()) for message in caplog.messages] == [1]


@pytest.mark.parametrize(("words", "message"), [
    (["--seconds", "-1"], "--seconds: -1.0 is not accepted; accepted: > 0"),
    (["--seconds", "0"], "--seconds: 0.0 is not accepted; accepted: > 0"),
    (["--seconds", "nan"], "--seconds: nan is not accepted; accepted: > 0"),
    (["--seed", "-1"], "--seed: -1 is not accepted; accepted: >= 0"),
    (["--width", "10"], "--width: 10 is not accepted; accepted: 160 to 1920"),
    (["--video", "walk.avi"], "--video: '.avi' is not accepted; accepted: .gif, .mp4, .webp"),
    (["--picture", "walk.jpg"], "--picture: 'walk.jpg' is not accepted; accepted: NAME.png"),
    (["--scenario", "moon"], "--scenario: 'moon' is not accepted; accepted: "),
    (["--level", "perfect"], "--level: 'perfect' is not accepted; accepted: "),
    (["--terrain", "stairs"], "terrain: 'stairs' is not accepted; accepted: checks, flat, plates, slope"),
    (["--config", "nowhere"], "nowhere/config.yaml: file is missing"),
])  # fmt: skip
def test_one_line_names_what_is_not_accepted(words, message, caplog):
    assert command.main(words) == 1
    assert len(caplog.messages) == 1
    assert caplog.messages[0].startswith("error: ")
    assert message in caplog.messages[0]
    assert "\n" not in caplog.messages[0]


def test_what_the_guide_draws_is_written_where_git_does_not_look():
    drawn = re.findall(r"--(?:video|picture) (\S+)", (ROOT / "docs/guide.md").read_text())
    assert drawn
    assert all(name.startswith("results/") for name in drawn)
    assert "/results/" in (ROOT / ".gitignore").read_text().splitlines()
