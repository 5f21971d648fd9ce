"""On which pages labels of a paper stand, and what lies too far from its first mention."""

import re
from collections.abc import Mapping

LABEL = re.compile(r"\\newlabel\{(?P<name>[^{}]+)\}\{\{(?:[^{}]|\{[^{}]*\})*\}\{(?P<page>\d+)\}")
END = "end:main"  # label of the end of the main text
FIRST = "at:"  # before the label of a float: where the text mentions it first
FAR = 2  # pages between a float of the main text and its first mention


def label_pages(aux: str) -> dict[str, int]:
    """Return label -> page, from 1, of TeX's .aux file."""
    return {found["name"]: int(found["page"]) for found in LABEL.finditer(aux)}


def place_faults(pages: Mapping[str, int], longest: int) -> list[str]:
    """Return what is wrong with the places: a main text of more than `longest` pages, and floats that lie too far."""
    end = pages.get(END)
    if end is None:
        return [f"no label {END!r}, which ends the main text"]
    faults = [f"the main text ends on page {end}; accepted: {longest}"] if end > longest else []
    for name, page in pages.items():
        mentioned = pages.get(f"{FIRST}{name}")
        if mentioned is not None and abs(page - mentioned) > FAR:
            faults.append(f"{name!r} stands on page {page} and is first mentioned on page {mentioned}")
    return faults
