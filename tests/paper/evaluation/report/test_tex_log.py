"""Faults of a page are found in TeX's log, with the table that was read last."""

import pytest

from experiments.evaluation.report.paper import page_faults


@pytest.mark.parametrize(
    ("log", "told"),
    [
        (r"Overfull \hbox (778.08pt too wide) in paragraph at lines 1--38", "(after main file)"),
        (r"Overfull \hbox (12.5pt too wide) in alignment at lines 7--9", "(after main file)"),
        (r"Overfull \hbox (6.0pt too wide) detected at line 30", "(after main file)"),
        (r"Overfull \vbox (5.1pt too high) has occurred while", "(after main file)"),
        ("Float too large for page by 271.5pt on input line 282", "(after main file)"),
        ("Label `tab:claims' multiply defined", ""),
        ("Reference `tab:none' on page 3 undefined", ""),
        ("Citation `nobody2020' on page 3 undefined", ""),
    ],
)
def test_a_fault_is_told_as_tex_tells_it(log: str, told: str) -> None:
    assert page_faults(f"LaTeX Font Info: ...\n{log}") == [f"{log} {told}".strip()]
    assert page_faults(f"LaTeX Warning: {log}.\n[]\n") == [f"{log} {told}".strip()]


def test_the_table_that_was_read_last_is_named_and_a_fault_once() -> None:
    lines = ["(./main.tex", "(./tables/a.tex) (./tables/noise_1.tex)", r"Overfull \hbox (9.0pt too wide) in paragraph"]
    told = [r"Overfull \hbox (9.0pt too wide) in paragraph (after tables/noise_1.tex)"]
    assert page_faults("\n".join([*lines, lines[-1]])) == told


@pytest.mark.parametrize("log", [r"Overfull \hbox (5.0pt too wide)", r"Underfull \hbox (badness 10000)", "Label(s)"])
def test_what_is_hardly_seen_is_no_fault(log: str) -> None:
    assert page_faults(log) == []
