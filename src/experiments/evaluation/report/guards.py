"""Guards of the paper's sentences: what they say in words stands only while verdicts and orders are as they say."""

import re
from collections.abc import Mapping

GUARDS = re.compile(r"\\(holds|below)\{([^{}]*)\}\s*\{([^{}]*)\}")
DEFINED = re.compile(r"\\csname (.+?)\\endcsname\{(.*)\}\n")  # a line of `evaluation.report.numbers`


def defined_texts(numbers: str) -> dict[str, str]:
    """Return name -> text of what numbers.tex defines."""
    return dict(DEFINED.findall(numbers))


def turned_guards(text: str, numbers: Mapping[str, str]) -> list[str]:
    r"""Return a line for each guard of a TeX text that no longer holds, in the text's order.

    \holds{claim}{verdict,...} holds if the claim's verdict is one of them, \below{cell}{cell} if the first number is
    smaller than the second. `numbers`: what numbers.tex defines.
    """
    lines = []
    for guard, first, second in GUARDS.findall(" ".join(text.split())):
        if guard == "holds":
            now = numbers.get(f"verdict@{first}", "missing")
            wanted = [one.strip() for one in second.split(",")]
            if now not in wanted:
                lines.append(f"claim {first!r} is {now!r}, and the text needs {' or '.join(map(repr, wanted))}")
        else:
            low, high = (numbers.get(f"value@{name}") for name in (first, second))
            if low is None or high is None or float(low) >= float(high):
                lines.append(f"{first!r} is {low}, and the text needs it below {second!r}, which is {high}")
    return list(dict.fromkeys(lines))
