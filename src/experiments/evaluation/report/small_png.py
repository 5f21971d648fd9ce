"""Pictures of the published results as PNG of few colours, which look the same and add less to the repository."""

from pathlib import Path

from PIL import Image

from mobnet.core.files import atomic_path

# A figure has a few colours and, where lines are smoothed, many between them: these are what can be told apart least.
COLOURS = 64
WHITE = (255, 255, 255)


def save_small(source: Path, out: Path) -> None:
    """Store a picture as a PNG of `COLOURS` colours on white; equal pictures give equal files."""
    with Image.open(source) as image:
        picture = image.convert("RGBA")
    paper = Image.new("RGBA", picture.size, WHITE)
    flat = Image.alpha_composite(paper, picture).convert("RGB")
    # Without dithering: it would put dots into even areas.
    few = flat.quantize(COLOURS, kmeans=1, dither=Image.Dither.NONE)
    with atomic_path(out) as temporary:
        few.save(temporary, "png", optimize=True)
