"""Clips: frames written as a GIF, an animated WebP, or an MP4 where the machine has ffmpeg."""

import contextlib
import shutil
import subprocess
from collections.abc import Iterable, Iterator
from itertools import chain
from pathlib import Path

from PIL import Image

from mobnet.core.errors import ConfigError, DrawingError, not_accepted
from mobnet.core.files import atomic_path
from mobnet.simulation.render import Pixels

ENDINGS = (".gif", ".webp", ".mp4")
COLOURS = 64  # of a GIF
WEBP_QUALITY = 70  # 0..100
MP4_QUALITY = 22  # of x264, 0 is lossless


def check_ending(path: Path) -> None:
    """Check that a clip can be written under this name.

    Raises:
        ConfigError: the ending is unknown, or there is no ffmpeg for an MP4.
    """
    if path.suffix not in ENDINGS:
        raise ConfigError(not_accepted("--video", path.suffix, ENDINGS))
    if path.suffix == ".mp4" and shutil.which("ffmpeg") is None:
        raise ConfigError(f"--video: {path.name} needs ffmpeg on the PATH; accepted without it: .gif, .webp")


def save_clip(frames: Iterable[Pixels], rate_hz: float, path: Path) -> None:
    """Write frames (height, width, 3), taken one by one, as a clip that repeats, as a whole or not at all.

    A GIF counts time in steps of 10 ms.

    Raises:
        ConfigError: the ending is not accepted.
        DrawingError: no frame came, or ffmpeg failed.
    """
    check_ending(path)
    frames = iter(frames)
    first = next(frames, None)
    if first is None:
        raise DrawingError(f"{path.name}: nothing to show")
    with atomic_path(path) as temporary:
        if path.suffix == ".mp4":
            _write_mp4(chain([first], frames), first.shape, rate_hz, temporary)
        else:
            _write_images(chain([first], frames), rate_hz, temporary)


def _write_images(frames: Iterator[Pixels], rate_hz: float, path: Path) -> None:
    """Write a GIF or a WebP; a GIF has the colours of its first frame and no dithering, which would make it large."""
    images = (Image.fromarray(frame) for frame in frames)
    first = next(images)
    if path.suffix == ".gif":
        first = first.quantize(COLOURS)
        palette = first
        images = (image.quantize(palette=palette, dither=Image.Dither.NONE) for image in images)
    options = {} if path.suffix == ".gif" else {"quality": WEBP_QUALITY}
    kind = path.suffix.removeprefix(".")
    frame_ms = round(1000 / rate_hz)
    with path.open("wb") as file:  # Pillow would leave a file of its own open at Ctrl-C
        first.save(file, kind, save_all=True, append_images=images, duration=frame_ms, loop=0, **options)


def _write_mp4(frames: Iterator[Pixels], shape: tuple[int, ...], rate_hz: float, path: Path) -> None:
    """Hand frames of a shape (height, width, 3) to ffmpeg."""
    source = f"-f rawvideo -pix_fmt rgb24 -s {shape[1]}x{shape[0]} -r {rate_hz:g} -i -"
    coding = f"-an -c:v libx264 -pix_fmt yuv420p -crf {MP4_QUALITY} -movflags +faststart -f mp4"
    words = ["ffmpeg", "-y", "-loglevel", "error", *source.split(), *coding.split(), str(path)]
    with subprocess.Popen(words, stdin=subprocess.PIPE, stderr=subprocess.PIPE) as ffmpeg:
        assert ffmpeg.stdin is not None
        with contextlib.suppress(BrokenPipeError):  # ffmpeg ended early, and says why
            for frame in frames:
                ffmpeg.stdin.write(frame.tobytes())
        _, said = ffmpeg.communicate()
    if ffmpeg.returncode:
        raise DrawingError(f"ffmpeg: {' '.join(said.decode(errors='replace').split())}")
