"""The number format in which a network learns, where the configuration leaves it to the processor."""

from pathlib import Path
from typing import Literal

from mobnet.settings.networks import Learning

AUTO = "auto"
PROCESSOR = Path("/proc/cpuinfo")
UNITS = {"avx512_bf16", "amx_bf16"}  # a CPU with one of these multiplies bfloat16 several times faster than float32
Precision = Literal["float32", "bfloat16"]


def of_processor() -> Precision:
    """Return bfloat16 where this machine's processor, as Linux describes it, computes in it."""
    flags = set(PROCESSOR.read_text(encoding="utf-8").split()) if PROCESSOR.exists() else set[str]()
    return "bfloat16" if flags & UNITS else "float32"


def in_precision(learning: Learning, name: Precision) -> Learning:
    """Return how networks learn, with a number format in place of `auto`."""
    return learning.model_copy(update={"precision": name}) if learning.precision == AUTO else learning
