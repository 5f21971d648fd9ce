"""Lines for the user: what happens, how large it is, and why a step failed."""

import re
import sys
from pathlib import Path

from mobnet.core.heartbeat import last_line

CAUSES = {  # what tools print -> what it means, and what to do
    r"No space left|os error 28|quota exceeded": "the disk is full; make room",
    r"Permission denied|os error 13|Read-only|os error 30": "no right to write; copy the project to a folder of yours",
    r"[Hh]ash mismatch|HASHES": "a package differs from its hash in environment.lock; set another index",
}
UNREACHABLE = r"name resolution|dns error|Failed to establish|\(Connect\)|unreachable|timed out|refused|tunnel"
NO_NETWORK = "no package registry can be reached; connect to a network, or set pip's index-url or proxy"


def say(text: str) -> None:
    """Tell the user one line."""
    sys.stderr.write(f"reproduce: {text}\n")


def step_of(path: Path, start: int) -> str:
    """Return what uv or pip is doing, from the last line behind the first `start` bytes of a log, if any."""
    last = last_line(path, start)
    # After this line uv compiles the packages to bytecode, most of its time, without a word.
    return f"{last}, compiling them" if last.startswith("Installed ") else last


def cause_of(output: str) -> str | None:
    """Return why a tool failed, if trying another way is of no use."""
    return next((meaning for pattern, meaning in CAUSES.items() if re.search(pattern, output)), None)


def is_unreachable(output: str) -> bool:
    """Return whether a tool failed because it found no network."""
    return re.search(UNREACHABLE, output) is not None


def in_gb(size: float) -> str:
    """Return a number of bytes as the user reads it."""
    return f"{size / 1e9:.1f} GB" if size >= 1e8 else f"{size / 1e6:.1f} MB"
