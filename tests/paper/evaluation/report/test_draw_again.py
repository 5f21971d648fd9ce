"""The published film is drawn again from the stored push, with the numbers of the run or not at all."""

import gzip
import shutil
from pathlib import Path

import pytest

from experiments.demo import DATA
from experiments.evaluation.measure.story import StoredPush
from experiments.evaluation.report.draw_again import AGAIN, draw_again
from experiments.settings.load import load_settings
from mobnet.core.errors import DataError
from mobnet.core.files import read_json, write_json

REPO = Path(__file__).parents[4]
PUBLISHED = REPO / "docs" / "results"
NUMBERS = Path("figures/push.csv.gz")


@pytest.fixture(scope="module")
def stored() -> StoredPush:
    """The stored push, with a film of few frames."""
    settings = load_settings()
    few = {"frames_hz": 5.0, "slowed_hz": 5.0}
    film = settings.evaluation.push_film.model_copy(update=few)
    evaluation = settings.evaluation.model_copy(update={"push_film": film})
    return StoredPush(DATA, settings.model_copy(update={"evaluation": evaluation}))


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    """A folder of published results with the numbers of the film."""
    (tmp_path / "figures").mkdir()
    shutil.copyfile(PUBLISHED / NUMBERS, tmp_path / NUMBERS)
    write_json(tmp_path / "provenance.json", {"scale": "default"})
    return tmp_path


def test_the_still_is_the_published_one_and_the_note_says_that_it_was_drawn_later(
    stored: StoredPush, folder: Path
) -> None:
    draw_again(stored, folder)
    assert (folder / "push.png").read_bytes() == (PUBLISHED / "push.png").read_bytes()
    assert (folder / "push.webp").stat().st_size > 10_000
    assert read_json(folder / "provenance.json") == {"scale": "default", "film": AGAIN}
    assert read_json(PUBLISHED / "provenance.json").get("film") in (AGAIN, None)  # that of a run has no such note
    assert sorted(path.name for path in folder.iterdir()) == ["figures", "provenance.json", "push.png", "push.webp"]


def test_a_film_with_other_numbers_than_the_published_ones_is_refused(stored: StoredPush, folder: Path) -> None:
    head, *rows = gzip.decompress((folder / NUMBERS).read_bytes()).splitlines(keepends=True)
    rows[0] = rows[0].replace(b".", b".0", 1)
    (folder / NUMBERS).write_bytes(gzip.compress(head + b"".join(rows)))
    with pytest.raises(DataError, match=r"push\.csv\.gz: its numbers are not those of .*demo"):
        draw_again(stored, folder)
    assert not (folder / "push.png").exists()


def test_the_published_push_has_the_alarm_of_the_run(stored: StoredPush) -> None:
    hit, push = stored.published()
    assert push.alarm is not None
    assert (hit.link, push.alarm.link, push.alarm.direction) == ("knee", "knee", "front")
    assert set(push.stds) == {"MOB-Net-pushed"}
