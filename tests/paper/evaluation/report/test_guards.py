"""A guard of the paper's words turns with its verdict or with the order of two numbers, and says so in a line."""

import pytest

from experiments.evaluation.report.paper import defined_texts, turned_guards

NUMBERS = {"verdict@hit": "direction", "value@t@a": "1.5", "value@t@b": "2.0"}


@pytest.mark.parametrize(
    "text",
    [
        r"words\holds{hit}{direction}", r"\holds{hit}{reproduced,direction}", r"\holds{hit}{reproduced, direction}",
        "\\holds{hit}%\n{direction}".replace("%", ""), r"\below{t@a}{t@b}", "no guard",
    ],
)  # fmt: skip
def test_a_guard_that_holds_says_nothing(text: str) -> None:
    assert turned_guards(text, NUMBERS) == []


@pytest.mark.parametrize(
    ("text", "told"),
    [
        (r"\holds{hit}{reproduced}", "claim 'hit' is 'direction', and the text needs 'reproduced'"),
        (
            r"\holds{no}{reproduced,direction}",
            "claim 'no' is 'missing', and the text needs 'reproduced' or 'direction'",
        ),
        (r"\below{t@b}{t@a}", "'t@b' is 2.0, and the text needs it below 't@a', which is 1.5"),
        (r"\below{t@a}{t@a}", "'t@a' is 1.5, and the text needs it below 't@a', which is 1.5"),
        (r"\below{t@a}{t@c}", "'t@a' is 1.5, and the text needs it below 't@c', which is None"),
    ],
)
def test_a_guard_that_turned_is_told_once(text: str, told: str) -> None:
    assert turned_guards(f"{text} and {text}", NUMBERS) == [told]


def test_what_numbers_tex_defines_is_read_from_it() -> None:
    lines = "\\newcommand{\\x}{y}\n\\expandafter\\def\\csname verdict@a b\\endcsname{not reproduced}\n"
    assert defined_texts(lines) == {"verdict@a b": "not reproduced"}
