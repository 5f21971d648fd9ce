"""The paper's text types no result, shows everything that it labels, and cites what it lists."""

import re
from pathlib import Path

REPO = Path(__file__).parents[4]
MAIN = (REPO / "paper/main.tex").read_text(encoding="utf-8")
TEXT = re.sub(r"(?<!\\)%.*", "", MAIN[MAIN.index(r"\begin{document}") :])
UNITS = r"(?:\\,|~| )?(?:\\Nm|N\\,m|N|ms|s|Hz|kHz|\\%|mm|kg|min|deg)(?![A-Za-z])"
TYPED = re.compile(rf"(?<![\w.@-])(\d+(?:\.\d+)?)({UNITS})")
LAYOUT = re.compile(
    r"\[[^\]]*(?:width|height)[^\]]*\]|\\(?:rule|mainfigure|columnfigure|supfigure)\{[^{}]*\}\{[^{}]*\}"
)
SET_UP = {  # typed quantities that are no result, and what they are
    r"1\,kHz": "rate of recordings and networks", r"2\,kHz": "rate of the simulation", r"95.6\,kg": "mass of the robot",
    r"15\,mm": "height of the checks", r"68\,\%": "share that sigma is scaled to", r"95\,\%": "confidence, found share",
    r"30\Nm": "torque of Figure 6", r"0.1\,s": "duration of that torque", r"200\,N": "largest hit of Figure 10",
    r"78\,ms": "duration of these hits", r"20\,kg": "mass of the longer hits", r"10\,N": "load of the hand",
    r"30\,N": "load of the hand, and of a push that is held", r"15\,Hz": "low-pass of the detectors",
    r"5\,ms": "time above a threshold", r"10\,\%": "margin of the paper's thresholds",
    r"10\,mm": "height of the plates",
    r"50\,N": "largest force on a hand",
    r"5\,N\,m": "largest moment on a hand",
    r"60\,N": "largest push of the swing foot in training", r"8\,s": "longest time between such pushes",
    r"140\,N": "largest push of the swing foot in the training of MOB-Net-pushed",
    r"50\,ms": "phase after a touch-down", r"30\,\%": "added friction of a changed robot",
}  # fmt: skip


def test_no_result_is_typed() -> None:
    typed = {number + unit for number, unit in TYPED.findall(LAYOUT.sub("", TEXT))}
    assert {r"30\Nm", r"78\,ms"} <= typed
    assert sorted(typed - SET_UP.keys()) == []
    assert sorted(SET_UP.keys() - typed) == []  # a quantity that left the text leaves the list


def labels() -> set[str]:
    """Return the labels of tables and figures, those of the commands that show one included."""
    shown = re.findall(r"\\(?:main|column)(table|figure)\{(\w+)\}", MAIN)
    shown += re.findall(r"\\(?:sup|wide)(table|figure)\{.*?\}%\n\s*\{(\w+)\}", MAIN, re.DOTALL)
    named = {f"{kind[:3]}:{name}" for kind, name in shown}
    return named | set(re.findall(r"\\label\{((?:tab|fig):\w+)\}", TEXT))


def test_every_table_and_figure_is_referenced() -> None:
    referenced = set(re.findall(r"\\(?:ref|see)\{((?:tab|fig):\w+)\}", TEXT))
    assert len(labels()) > 60
    assert sorted(labels() - referenced) == []


def test_every_table_and_figure_of_the_main_text_is_mentioned_by_the_command_that_is_checked() -> None:
    main = TEXT[: TEXT.index(r"\label{end:main}")]
    shown = re.findall(r"\\(?:main|column)(table|figure)\{(\w+)\}", main)
    floats = {f"{kind[:3]}:{name}" for kind, name in shown}
    floats |= set(re.findall(r"\\label\{((?:tab|fig):\w+)\}", main))
    assert len(floats) > 10
    assert floats == set(re.findall(r"\\see\{([\w:]+)\}", main))


def test_every_caption_is_one_of_the_report() -> None:
    """But for the deviations, whose table is made from a page of the documents."""
    captions = re.findall(r"\\caption\{(.{0,12})", MAIN)
    assert [start for start in captions if not start.startswith((r"\capt{", "(continued)", r"\textbf{Dev"))] == []


def test_every_work_is_cited_and_every_citation_listed() -> None:
    listed = re.findall(r"^@\w+\{(\w+),", (REPO / "paper/refs.bib").read_text(encoding="utf-8"), re.MULTILINE)
    cited = {name for names in re.findall(r"\\cite\{([\w,]+)\}", TEXT) for name in names.split(",")}
    assert len(listed) == len(set(listed)) >= 30
    assert cited == set(listed)


def test_no_table_is_set_in_type_below_seven_points() -> None:
    r"""Of which \scriptsize has seven in this class."""
    assert r"\scriptsize" in MAIN
    assert re.findall(r"\\tiny|\\fontsize|\\(?:resize|scale)box", MAIN) == []
