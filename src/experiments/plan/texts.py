"""What the paper's text takes from the configuration: claims by their names."""

import re
from collections.abc import Iterator
from pathlib import Path

from experiments.settings.settings import Settings
from mobnet.core.errors import not_accepted
from mobnet.settings.reading import Place

MACROS = re.compile(
    r"\\(?:claimed|claimedshare|found|foundshare|foundspan|verdict|cause|holds)\{([\w-]+)\}"
)  # of `evaluation.report.numbers`


def text_problems(settings: Settings, text: Path) -> Iterator[tuple[Place, str]]:
    """Yield the claims that a TeX file names and the configuration lacks; TeX would miss them at the end of a run."""
    for name in dict.fromkeys(MACROS.findall(text.read_text(encoding="utf-8"))):
        if name not in settings.claims:
            yield ("claims", name), not_accepted(f"claim in {text.name}", name, settings.claims)
