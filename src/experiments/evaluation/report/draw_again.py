"""The published film of the push, drawn again from the push that docs/demo stores: where a drawing alone changed.

`python -m experiments.evaluation.report.draw_again` writes push.webp and push.png in docs/results. Its numbers must be
those that the run published; `provenance.json` says that the film was drawn after the run.
"""

import gzip
import logging
import sys
import tempfile
from pathlib import Path

from experiments.evaluation.figures.drawing.push_film import draw_film
from experiments.evaluation.measure.story import StoredPush
from experiments.evaluation.report.snapshot import DEMO, DRAWN, SNAPSHOT, note_renewal, run_renewal, save_small
from experiments.settings.load import load_settings
from mobnet.core.errors import DataError

log = logging.getLogger(__name__)
FILM = "push"
AGAIN = "drawn after the run from the push in docs/demo"  # what the note of a snapshot says


def draw_again(stored: StoredPush, published: Path) -> None:
    """Draw the film of a stored push into a folder of published results.

    Raises:
        DataError: a file is missing or damaged, or a number of the film is not the published one.
    """
    settings = stored.settings
    whole = settings.evaluation
    robot = settings.robot
    hit, push = stored.published()
    with tempfile.TemporaryDirectory(dir=published.parent, prefix=".film") as name:
        film = Path(name) / f"{FILM}.webp"
        draw_film(whole.push_film, stored.story, whole.peaks, robot, robot.looks, robot.layout, hit, push, film)
        numbers = film.with_suffix(".csv").read_bytes()
        told = published / DRAWN / f"{FILM}.csv.gz"
        if gzip.decompress(told.read_bytes()) != numbers:
            raise DataError(f"{told}: its numbers are not those of {stored.folder}; ./reproduce snapshot stores both")
        film.replace(published / film.name)
        save_small(film.with_suffix(".png"), published / f"{FILM}.png")
    note_renewal(published, "film", AGAIN)
    log.info("%s: the film of the push is drawn again", published)


def main() -> int:
    """Draw the published film again; return the exit status."""
    return run_renewal(lambda: draw_again(StoredPush(DEMO, load_settings()), SNAPSHOT), log)


if __name__ == "__main__":
    sys.exit(main())
