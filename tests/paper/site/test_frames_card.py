"""The page of frames is current: it has every column of their schemas."""

from pathlib import Path

from experiments.site.frames_card import CARD, card

REPO = Path(__file__).parents[3]


def test_the_page_is_current() -> None:
    assert (REPO / CARD).read_text() == card(), "python -m experiments.site frames writes it"
