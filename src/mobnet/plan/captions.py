"""How the report shows a file: its heading, its title and its caption."""

from dataclasses import dataclass
from pathlib import Path

CAPTIONS = Path("workflow/report")
HEADINGS = {"runs.html": "trainings", "main.pdf": "paper", ".html": "tables", ".png": "figures"}


@dataclass(frozen=True)
class Shown:
    """How the report shows a file: its heading, also the folder of its caption, its title, and its caption."""

    heading: str
    title: str
    caption: Path | None


def shown(file: str) -> Shown | None:
    """Return how the report shows a file; None if it does not."""
    path = Path(file)
    heading = HEADINGS.get(path.name, HEADINGS.get(path.suffix))
    if heading is None:
        return None
    caption = CAPTIONS / heading / f"{path.stem}.rst"
    if not caption.is_file():
        return Shown(heading, path.stem, None)
    return Shown(heading, caption.read_text(encoding="utf-8").splitlines()[0], caption)
