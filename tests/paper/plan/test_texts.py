"""Claims that the paper's text names stand in the configuration."""

from pathlib import Path

from experiments.settings.checks.claims import text_problems
from experiments.settings.settings import Settings

PAPER = Path(__file__).parents[3] / "paper" / "main.tex"


def test_a_claim_of_the_paper_that_is_not_there_is_named(settings: Settings) -> None:
    assert not list(text_problems(settings, PAPER))
    fewer = {name: claim for name, claim in settings.claims.items() if name != "rte-walk"}
    ((place, text),) = text_problems(settings.model_copy(update={"claims": fewer}), PAPER)
    assert place == ("claims", "rte-walk")
    assert text.startswith("claim in main.tex: 'rte-walk' is not accepted; accepted: ")
