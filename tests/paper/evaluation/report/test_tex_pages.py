"""Labels have the pages of TeX's .aux file; a long main text and a float far from its mention are told."""

from experiments.evaluation.report.paper import label_pages, place_faults

AUX = r"""
\newlabel{tab:legs}{{I}{4}}
\newlabel{at:tab:legs}{{V}{3}}
\newlabel{fig:far}{{3}{7}}
\newlabel{at:fig:far}{{V\nobreakspace{}A}{4}}
\newlabel{end:main}{{XIV}{8}}
"""


def test_the_main_text_ends_where_its_label_is() -> None:
    pages = label_pages(AUX)
    assert pages["end:main"] == 8
    assert place_faults({"end:main": 8}, 8) == []
    assert place_faults({"end:main": 9}, 8) == ["the main text ends on page 9; accepted: 8"]
    assert place_faults({}, 8) == ["no label 'end:main', which ends the main text"]


def test_a_float_far_from_its_first_mention_is_told() -> None:
    assert place_faults(label_pages(AUX), 8) == ["'fig:far' stands on page 7 and is first mentioned on page 4"]
