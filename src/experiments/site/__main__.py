"""Renew the documents that are made: `python -m experiments.site`, or some of them by their names.

A test fails where one is out of date.
"""

import logging
import sys
from collections.abc import Callable, Mapping, Sequence

from experiments.site import (
    data_card,
    deposit,
    folder_page,
    frames_card,
    machines,
    model_card,
    paper_map,
    processor,
    readme,
    why_note,
)
from mobnet.core.errors import CommandError, MobnetError, not_accepted

log = logging.getLogger(__name__)
DOCUMENTS: Mapping[str, Callable[[], None]] = {
    "archives": deposit.renew,
    "data": data_card.renew,
    "frames": frames_card.renew,
    "map": paper_map.renew,
    "model": model_card.renew,
    "processor": processor.renew,
    "readme": readme.tell_readme,
    "results": folder_page.write_page,
    "why": why_note.renew,
    "machines": machines.renew,  # last, as it plans every scale
}


def main(words: Sequence[str]) -> int:
    """Renew the documents that are named, or all; return the exit status."""
    logging.basicConfig(level=logging.INFO, format="%(message)s", stream=sys.stdout)
    try:
        for name in words:
            if name not in DOCUMENTS:
                raise CommandError(not_accepted("document", name, DOCUMENTS))
        for name in words or DOCUMENTS:
            DOCUMENTS[name]()
            log.info("%s: renewed", name)
    except MobnetError as fault:
        log.error("%s", fault)
        return 1
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
