"""Published figures are drawn from their CSVs alone, as the PNG beside them shows them."""

import shutil
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from experiments.evaluation.figures.style import save_picture
from experiments.settings.load import load_settings
from experiments.settings.settings import Settings
from experiments.site.redraw import Stored, drawn_from_csv, redraw
from mobnet.core.errors import ConfigError, DataError

PUBLISHED = Path(__file__).parents[3] / "docs" / "results"


@pytest.fixture(scope="module")
def settings() -> Settings:
    """The configuration."""
    return load_settings()


@pytest.fixture
def stored(settings: Settings, tmp_path: Path) -> Stored:
    """A folder with the published numbers of one figure, and nothing else."""
    (tmp_path / "figures").mkdir()
    shutil.copyfile(PUBLISHED / "figures/commands.csv.gz", tmp_path / "figures/commands.csv.gz")
    return Stored(tmp_path, settings)


def test_a_figure_is_drawn_as_svg_and_pdf_from_its_csv_alone(stored: Stored, tmp_path: Path) -> None:
    redraw(stored, ["commands"], tmp_path / "out")
    assert sorted(path.name for path in (tmp_path / "out").iterdir()) == ["commands.pdf", "commands.svg"]
    assert b"<svg" in (tmp_path / "out/commands.svg").read_bytes()
    assert (tmp_path / "out/commands.pdf").read_bytes().startswith(b"%PDF")


def test_a_drawing_looks_as_the_published_picture(stored: Stored, tmp_path: Path) -> None:
    save_picture(drawn_from_csv()["commands"](stored, "commands"), tmp_path / "commands", (".png",))
    drawn, published = (pixels_of(folder / "commands.png") for folder in (tmp_path, PUBLISHED))
    assert drawn.shape == published.shape
    assert np.abs(drawn - published).mean() < 1.0  # of 255: the published one has fewer colours


def pixels_of(path: Path) -> np.ndarray:
    """Return the pixels of a picture on white (height, width, 3)."""
    with Image.open(path) as image:
        picture = image.convert("RGBA")
    return np.asarray(Image.alpha_composite(Image.new("RGBA", picture.size, "white"), picture).convert("RGB"), float)


def test_every_name_is_that_of_a_published_figure() -> None:
    assert len(drawn_from_csv()) == 26
    assert {name for name in drawn_from_csv() if not (PUBLISHED / f"{name}.png").is_file()} == set()


def test_what_cannot_be_drawn_is_one_line(stored: Stored, tmp_path: Path) -> None:
    with pytest.raises(ConfigError, match=r"figure_13.*\./reproduce figures/figure_13\.pdf makes it in a run"):
        redraw(stored, ["figure_13"], tmp_path / "out")
    with pytest.raises(DataError, match=r"figure_14\.csv\.gz: file is missing"):
        redraw(stored, ["figure_14"], tmp_path / "out")
