"""The number format in which a network learns, where the configuration leaves it to the processor.

A unit for bfloat16 does not tell that a GRU learns faster in it: on processors with matrix units (AMX), the
instruction for pairs that `tiles` uses is slower than float32. Both formats are therefore tried, once for each kind of
processor and each state of the code, and what they took is kept beside the machine code (docs/notes/precision.md).
"""

import contextlib
import hashlib
import math
import re
import time
from pathlib import Path
from typing import Literal

from mobnet.core.code import SHORT, code_hash
from mobnet.core.errors import DataError
from mobnet.core.files import read_json, write_json
from mobnet.core.machine import one_thread
from mobnet.core.notes import Note, Positive, checked
from mobnet.core.root import caches
from mobnet.settings.networks import Learning

AUTO = "auto"
PROCESSOR = Path("/proc/cpuinfo")
DESCRIBED = re.compile(r"^(?:model name|flags)\s*:.*$", re.MULTILINE)  # what tells one kind of processor from another
UNITS = {"avx512_bf16", "amx_bf16"}  # a processor without one of these takes bfloat16 apart: it is not tried
Precision = Literal["float32", "bfloat16"]
GAIN = 0.9  # of float32's time is the most that bfloat16 may take: its digits are not given away for a chance
STEPS, LANES, INPUTS, HIDDEN = 10, 64, 30, 150  # of the trial: a leg's GRU of Table 1 and its batch
TURNS = 5


class FormatTimes(Note):
    """What a processor takes to learn in each format [ms], and the format that follows."""

    precision: Precision
    float32_ms: Positive
    bfloat16_ms: Positive


def of_processor() -> Precision:
    """Return the format in which a GRU learns faster here; it is tried once for each kind of processor."""
    kind = _kind_of_processor()
    if not UNITS & set(kind.split()):
        return "float32"
    place = _record_of(kind)
    with contextlib.suppress(DataError):  # there is none yet, or it is damaged
        return checked(place, read_json(place), FormatTimes).precision
    float32_ms, bfloat16_ms = tried_ms()
    name: Precision = "bfloat16" if bfloat16_ms < GAIN * float32_ms else "float32"
    with contextlib.suppress(DataError):  # where nothing can be kept, the next process tries again
        write_json(place, {"precision": name, "float32_ms": float32_ms, "bfloat16_ms": bfloat16_ms})
    return name


def tried_ms() -> tuple[float, float]:
    """Return the least processor time [ms] in which a GRU goes forward and back in float32 and in bfloat16, in turns.

    Products, gates and rounding are those of a training.
    """
    import torch  # here: it starts slowly, and the workflow asks for the format before it starts

    from mobnet.learning.gru import run_gru
    from mobnet.learning.model import seeded

    one_thread()
    with seeded(0):
        cell = torch.nn.GRU(INPUTS, HIDDEN)
    x = torch.zeros(STEPS, LANES, INPUTS)
    state = torch.zeros(1, LANES, HIDDEN)
    formats = torch.float32, torch.bfloat16
    least = dict.fromkeys(formats, math.inf)
    for _ in range(1 + TURNS):  # the first one may compile
        for name in formats:
            started = time.process_time()
            with torch.autocast("cpu", name, enabled=name != torch.float32):
                states, _ = run_gru(cell, x, state)
            states.sum().backward()
            least[name] = min(least[name], 1e3 * (time.process_time() - started))
    return least[torch.float32], least[torch.bfloat16]


def in_precision(learning: Learning, name: Precision) -> Learning:
    """Return how networks learn, with a number format in place of `auto`."""
    return learning.model_copy(update={"precision": name}) if learning.precision == AUTO else learning


def _kind_of_processor() -> str:
    """Return the name and the flags of this machine's processor, as Linux describes it."""
    text = PROCESSOR.read_text(encoding="utf-8") if PROCESSOR.exists() else ""
    return "\n".join(sorted(set(DESCRIBED.findall(text))))


def _record_of(kind: str) -> Path:
    """Return the file that keeps what a kind of processor takes, of the code as it is."""
    parts = kind, code_hash("mobnet.learning.gru")
    return caches() / "precision" / f"{hashlib.sha256(repr(parts).encode()).hexdigest()[:SHORT]}.json"
