"""Text of tables: nothing TeX would choke on, columns that line up."""

import pytest

from mobnet.evaluation.tables.layout import GAP, RULE, long_table, markdown_table, number, span, tex_escape, tex_table


@pytest.mark.parametrize("character", list("\\&%$#_{}~^<>|"))
def test_special_characters_are_escaped(character: str) -> None:
    assert tex_escape(f"a{character}b") not in (f"a{character}b", "ab")


def test_numbers_stay_with_their_unit() -> None:
    assert tex_escape("10 to 30 N m") == r"10 to 30~N\,m"


def test_a_minus_is_set_as_one_and_a_hyphen_as_one() -> None:
    assert tex_escape("-4.5, [-1.20, 2-3]") == "$-$4.5, [$-$1.20, 2-3]"
    assert tex_escape("MOB-Net-hidden-44, -") == "MOB-Net-hidden-44, -"


def test_every_row_has_as_many_separators_as_the_header() -> None:
    text = tex_table("lr", ["a", "b"], [["x", "1"], RULE, ["y", "2"], GAP])
    rows = [line for line in text.splitlines() if line.endswith(r"\\")]
    assert len(rows) == 3
    assert {row.count("&") for row in rows} == {1}
    assert text.count(r"\midrule") == 2


def test_markdown_rows_have_the_same_cells_and_rules_are_left_out() -> None:
    lines = markdown_table(["a", "b"], [["x|y", "1"], RULE, ["z", "2"]]).splitlines()
    assert lines == ["| a | b |", "| --- | ---: |", "| x\\|y | 1 |", "| z | 2 |"]


def test_what_is_not_known_is_blank_not_invented() -> None:
    assert (number(None), span(None, None), span(1.0, None)) == ("-", "", "")
    assert (number(1.005, 1), span(1.0, 2.0)) == ("1.0", "[1.00, 2.00]")


def test_a_long_table_repeats_its_header_and_ends_each_page_with_a_rule() -> None:
    lines = long_table("lr", r"\caption{c}", ["a_1", "b"], [["50 %", "1"], r"\multicolumn{2}{l}{why} \\"]).splitlines()
    assert lines == [
        r"\begin{longtable}{lr}", r"\caption{c} \\", r"\toprule", r"a\_1 & b \\", RULE, r"\endhead", r"\bottomrule",
        r"\endfoot", r"50 \% & 1 \\", r"\multicolumn{2}{l}{why} \\", r"\end{longtable}",
    ]  # fmt: skip


def test_what_rounds_to_zero_has_no_sign() -> None:
    assert [number(-0.004), number(-0.3, 0), number(-0.006)] == ["0.00", "0", "-0.01"]
    assert span(-0.4, 0.4, 0) == "[0, 0]"
