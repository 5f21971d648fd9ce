"""Text of tables: nothing TeX would choke on, columns that line up."""

from pathlib import Path

from experiments.evaluation.number.number import Number
from experiments.evaluation.tables.layout import (
    GAP,
    RULE,
    Table,
    in_blocks,
    long_table,
    markdown_table,
    tex_escape,
    with_intervals,
    write_table,
)


def test_special_characters_are_escaped_and_numbers_stay_with_their_unit() -> None:
    for character in "\\&%$#_{}~^<>|":
        assert tex_escape(f"a{character}b") not in (f"a{character}b", "ab")
    assert tex_escape("10 to 30 N m") == r"10 to 30~N\,m"


def test_a_minus_is_set_as_one_and_a_hyphen_as_one() -> None:
    assert tex_escape("-4.5, [-1.20, 2-3]") == "$-$4.5, [$-$1.20, 2-3]"
    assert tex_escape("MOB-Net-hidden-44, -") == "MOB-Net-hidden-44, -"


def test_markdown_rows_have_the_same_cells_and_rules_are_left_out() -> None:
    lines = markdown_table(["a", "b"], [["x|y", "1"], RULE, ["z", "2"]]).splitlines()
    assert lines == ["| a | b |", "| --- | ---: |", "| x\\|y | 1 |", "| z | 2 |"]


def test_readers_see_a_name_that_says_that_a_method_estimates_nothing(tmp_path: Path) -> None:
    write_table(tmp_path / "t", Table(["method"], [["zero"]], ["Method", "zero"], [["zero", "0.50"]]))
    assert (tmp_path / "t.csv").read_text() == "method\nzero\n"
    assert "zero" not in (tmp_path / "t.md").read_text() + (tmp_path / "t.tex").read_text()
    assert r"no estimate & 0.50 \\" in (tmp_path / "t.tex").read_text()


def test_a_long_table_has_its_caption_once_repeats_its_header_and_ends_each_page_with_a_rule() -> None:
    lines = long_table("lr", r"\caption{c}", ["a_1", "b"], [["50 %", "1"], r"\multicolumn{2}{l}{why} \\"]).splitlines()
    head = [r"\toprule", r"a\_1 & b \\", RULE]
    assert lines == [
        r"\begin{longtable}{lr}", r"\caption{c} \\", *head, r"\endfirsthead", *head, r"\endhead", r"\bottomrule",
        r"\endfoot", r"50 \% & 1 \\", r"\multicolumn{2}{l}{why} \\", r"\end{longtable}",
    ]  # fmt: skip


BLOCKS = [(("a", "x"), [["1"], ["2"]]), (("a", "y"), [["3"]]), (("b", "y"), [["4"]])]


def test_blocks_have_their_labels_once_and_rules_between_them() -> None:
    assert in_blocks(BLOCKS) == [
        ["a", "x", "1"], ["", "", "2"], RULE, ["a", "y", "3"], RULE, ["b", "y", "4"],
    ]  # fmt: skip
    assert in_blocks(BLOCKS, nested=True) == [
        ["a", "x", "1"], ["", "", "2"], GAP, ["", "y", "3"], RULE, ["b", "y", "4"],
    ]  # fmt: skip


def test_intervals_stand_below_the_numbers_if_there_are_any() -> None:
    numbers = [Number(1.0, 0.5, 1.5), Number(2.0)]
    assert with_intervals(["a", "b"], numbers, 0.95) == [["a", "b", "1.00", "2.00"], ["", "95%", "[0.50, 1.50]", ""]]
    assert with_intervals(["a", "b"], numbers[1:], 0.95) == [["a", "b", "2.00"]]


def test_one_table_is_three_files(tmp_path: Path) -> None:
    table = Table(
        ("a", "b"), [("x_1", 0.25), ("y", None)], ["A_1", "B"], [["x_1", "0.25"], RULE, ["y", "-"], GAP], note="50 %"
    )
    write_table(tmp_path / "t", table)
    assert (tmp_path / "t.csv").read_text() == "a,b\nx_1,0.25\ny,\n"
    assert (tmp_path / "t.md").read_text() == "| A_1 | B |\n| --- | ---: |\n| x_1 | 0.25 |\n| y | - |\n\n50 %\n"
    assert (tmp_path / "t.tex").read_text().splitlines() == [
        r"\begin{tabular}{lr}", r"\toprule", r"A\_1 & B \\", r"\midrule", r"x\_1 & 0.25 \\", r"\midrule", r"y & - \\",
        GAP, r"\bottomrule", r"\end{tabular}", r"\par\smallskip\parbox{\linewidth}{\raggedright 50 \%}",
    ]  # fmt: skip
    write_table(tmp_path / "t", table, "other")
    assert (tmp_path / "t.tex").read_text().startswith("other")
