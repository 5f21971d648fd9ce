"""Clips: every frame, in order, at its pace; written as a whole or not at all."""

import shutil

import numpy as np
import pytest
from PIL import Image

from mobnet.core.errors import ConfigError, DrawingError
from mobnet.simulation.clip import ENDINGS, check_ending, save_clip

HAS_FFMPEG = shutil.which("ffmpeg") is not None


def frames(count=5):
    for k in range(count):
        pixels = np.full((24, 32, 3), 200, dtype=np.uint8)
        pixels[:12] = [40, 90, 160]
        pixels[:, 4 * k : 4 * k + 4] = [230, 60, 20]
        yield pixels


@pytest.mark.parametrize("ending", [".gif", ".webp"])
def test_every_frame_comes_back_in_its_place_and_time(tmp_path, ending):
    path = tmp_path / f"bar{ending}"
    save_clip(frames(), 12.5, path)
    with Image.open(path) as clip:
        assert (clip.n_frames, clip.size) == (5, (32, 24))
        for k, pixels in enumerate(frames()):
            clip.seek(k)
            shown = np.asarray(clip.convert("RGB")).astype(int)
            assert clip.info["duration"] == 80
            assert np.median(np.abs(shown - pixels)) <= 4
            assert (
                shown[:, 4 * k : 4 * k + 4, 0].mean() > 200 > 150 > shown[:12, [4 * k - 2, (4 * k + 6) % 32], 0].mean()
            )


@pytest.mark.skipif(not HAS_FFMPEG, reason="no ffmpeg here")
def test_ffmpeg_makes_an_mp4(tmp_path):
    save_clip(frames(), 12.5, tmp_path / "bar.mp4")
    assert (tmp_path / "bar.mp4").read_bytes()[4:8] == b"ftyp"


def test_ffmpeg_gets_every_pixel_in_order(tmp_path, monkeypatch):
    """A stand-in writes down what it is given: frames as they are, and their size and pace among the words."""
    words = fake_ffmpeg(
        tmp_path, monkeypatch, 'for last; do :; done; echo "$@" > "$(dirname "$0")/words"; cat > "$last"'
    )
    save_clip(frames(), 12.5, tmp_path / "bar.mp4")
    assert (tmp_path / "bar.mp4").read_bytes() == b"".join(pixels.tobytes() for pixels in frames())
    assert "-s 32x24 -r 12.5 -i -" in words.read_text()


def test_what_ffmpeg_says_when_it_fails_is_one_line(tmp_path, monkeypatch):
    fake_ffmpeg(tmp_path, monkeypatch, "echo no such >&2; echo encoder >&2; exit 3")
    with pytest.raises(DrawingError, match=r"^ffmpeg: no such encoder$"):
        save_clip(frames(2000), 12.5, tmp_path / "bar.mp4")
    assert not (tmp_path / "bar.mp4").exists()


def fake_ffmpeg(folder, monkeypatch, script):
    """Put an ffmpeg of a few shell lines on the PATH; return where it may note its words."""
    tools = folder / "tools"
    tools.mkdir()
    (tools / "ffmpeg").write_text(f"#!/bin/sh\n{script}\n")
    (tools / "ffmpeg").chmod(0o755)
    monkeypatch.setenv("PATH", str(tools), prepend=":")
    return tools / "words"


@pytest.mark.parametrize("ending", [".gif", ".webp"])
@pytest.mark.parametrize("broken", [KeyboardInterrupt, DrawingError])
def test_an_interrupted_clip_leaves_the_old_one(tmp_path, ending, broken):
    def break_off():
        yield from frames(2)
        raise broken

    path = tmp_path / f"bar{ending}"
    path.write_text("old")
    with pytest.raises(broken):
        save_clip(break_off(), 12.5, path)
    assert path.read_text() == "old"
    assert list(tmp_path.iterdir()) == [path]


def test_no_frame_is_no_clip(tmp_path):
    with pytest.raises(DrawingError, match=r"bar\.gif: nothing to show"):
        save_clip(iter([]), 12.5, tmp_path / "bar.gif")
    assert not list(tmp_path.iterdir())


def test_endings_are_named(tmp_path, monkeypatch):
    monkeypatch.setenv("PATH", str(tmp_path))
    with pytest.raises(ConfigError, match=r"walk\.mp4 needs ffmpeg on the PATH; accepted without it: \.gif, \.webp"):
        check_ending(tmp_path / "walk.mp4")
    for ending in set(ENDINGS) - {".mp4"}:
        check_ending(tmp_path / f"walk{ending}")
