"""The notebook of the examples as a program."""

from pathlib import Path

import nbformat

FOLDER = Path(__file__).parents[1] / "docs" / "examples"
NOTEBOOK = FOLDER / "push.ipynb"


def cells():
    return nbformat.read(NOTEBOOK, as_version=4).cells


def program():
    """Return the code of its cells in their order."""
    return "\n".join(cell.source for cell in cells() if cell.cell_type == "code")
