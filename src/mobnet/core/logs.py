"""What a job of the workflow tells: progress to its log file and the terminal, an error as one line."""

from __future__ import annotations

import contextlib
import logging
import sys
from collections.abc import Iterator
from pathlib import Path

from mobnet.core.errors import MobnetError

log = logging.getLogger(__name__)

FORMAT = "%(asctime)s %(levelname)s %(message)s"


@contextlib.contextmanager
def job(log_file: Path | str) -> Iterator[None]:
    """Log a job to its file and to the terminal.

    Raises:
        SystemExit: the job raised a MobnetError; its message is the last line of the log.
    """
    path = Path(log_file)
    path.parent.mkdir(parents=True, exist_ok=True)
    handlers = [logging.FileHandler(path, mode="w", encoding="utf-8"), logging.StreamHandler(sys.stderr)]
    root = logging.getLogger()
    previous = root.handlers[:], root.level
    root.handlers[:] = []
    for handler in handlers:
        handler.setFormatter(logging.Formatter(FORMAT, "%H:%M:%S"))
        root.addHandler(handler)
    logging.getLogger("mobnet").setLevel(logging.INFO)
    logging.captureWarnings(capture=True)
    try:
        yield
    except MobnetError as error:
        log.error("%s", error)
        raise SystemExit(1) from None
    finally:
        logging.captureWarnings(capture=False)
        handlers[0].close()
        root.handlers[:], root.level = previous
