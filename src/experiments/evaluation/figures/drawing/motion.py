"""Drawings that move: frames of few colours as an animated WebP without loss, and as a GIF. Writing only."""

from collections.abc import Sequence
from pathlib import Path

import numpy as np
from PIL import Image

from mobnet.core.files import atomic_path
from mobnet.simulation.render import Pixels

MS = 1000.0
NEAR_WHITE = 251  # of 255
EFFORT = {"quality": 50, "method": 3}  # of WebP without loss: more takes longer and saves nothing


def save_still(frame: Pixels, path: Path) -> None:
    """Write one frame (height, width, 3) as a PNG, as a whole or not at all."""
    with atomic_path(path) as temporary:
        Image.fromarray(frame).save(temporary, "png", optimize=True)


def palette_of(frame: Pixels, colours: int) -> Image.Image:
    """Return an image with a palette of the main colours of a frame (height, width, 3); almost white is white."""
    image = Image.fromarray(frame).quantize(colours)
    palette = np.reshape(image.getpalette() or [], (-1, 3))
    palette[palette.min(axis=1) >= NEAR_WHITE] = 255
    image.putpalette(palette.ravel().tolist())
    return image


def save_drawing(frames: Sequence[Pixels], seen_s: Sequence[float], palette: Image.Image, out: Path) -> None:
    """Write frames (height, width, 3), each seen for a time [s], as a WebP and a GIF that repeat.

    Drawings have few colours: with those of a palette, WebP without loss is smaller than with it, and text is sharp.
    """
    flat = [Image.fromarray(frame).quantize(palette=palette, dither=Image.Dither.NONE) for frame in frames]
    duration = [round(MS * time_s) for time_s in seen_s]
    _save([image.convert("RGB") for image in flat], out.with_suffix(".webp"), duration, lossless=True, **EFFORT)
    _save(flat, out.with_suffix(".gif"), duration)


def _save(images: Sequence[Image.Image], path: Path, duration: Sequence[int], **options: int) -> None:
    """Write images with their durations [ms] in the format of the path's ending."""
    with atomic_path(path) as temporary:
        first, *others = images
        kind = path.suffix.removeprefix(".")
        first.save(temporary, kind, save_all=True, append_images=others, duration=list(duration), loop=0, **options)
