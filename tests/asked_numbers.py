"""The numbers that the paper's text asks for, by their names in numbers.tex."""

import re

NAMES = {  # command of the text -> names of its numbers
    "ours": ("ours@forward_walk@{}@{}@{}@rmse",),
    "published": ("published@forward_walk@{}@{}@{}@rmse",),
    "ourcell": ("ours@{}@{}@{}@{}@{}",),
    "publishedcell": ("published@{}@{}@{}@{}@{}",),
    "foundspan": ("span@{}",),
    "holds": ("verdict@{}",),
    "below": ("value@{}", "value@{}"),
    "scored": ("scored@{}@{}",),
    "counted": ("counted@{}@{}",),
    **{
        name: (f"{name}@{{}}",)
        for name in (
            "cell", "cellspan", "cellshare", "cellsharespan", "claimed", "found", "claimedshare", "foundshare",
            "verdict", "cause", "size",
        )
    },
}  # fmt: skip
CALL = re.compile(r"\\(\w+)((?:\{[^{}]*\})+)")


def asked_names(text: str) -> list[str]:
    """Return the names of all numbers that a TeX text asks for, each once."""
    names = []
    body = text[text.index(r"\begin{document}") :]
    for command, arguments in CALL.findall(" ".join(body.split())):
        given = arguments[1:-1].split("}{")
        wanted = NAMES.get(command, ())
        names += [name.format(*given) for name in wanted] if len(wanted) == 1 else []
        names += [name.format(one) for name, one in zip(wanted, given, strict=True)] if len(wanted) > 1 else []
    return list(dict.fromkeys(names))
