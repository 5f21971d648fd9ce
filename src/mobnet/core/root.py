"""The folder that the package lies in, whether that is a checkout, and where what can be made again is kept.

Standard library only.
"""

import os
from pathlib import Path

ROOT = Path(__file__).parents[3]
IS_CHECKOUT = (ROOT / "reproduce").is_file()


def caches() -> Path:
    """Return the folder of what can be made again, such as machine code: in a checkout, or the user's."""
    if IS_CHECKOUT:
        return ROOT / ".cache"
    return Path(os.environ.get("XDG_CACHE_HOME") or Path.home() / ".cache") / "mobnet"
