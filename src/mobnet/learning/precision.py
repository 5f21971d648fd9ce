"""The number format of a GRU's matrix products in training: float32, or bfloat16 with float32's range and 8 bits.

Weights, gates and states stay float32; only what goes into a product and comes out of it is rounded.
"""

import torch

from mobnet.settings.networks import Precision

PRECISIONS = {"float32": torch.float32, "bfloat16": torch.bfloat16}
UNITS = ("avx512_bf16", "amx_bf16")  # a CPU with one of these multiplies bfloat16 several times faster than float32


def precision_of(setting: Precision, device: torch.device) -> torch.dtype:
    """Return the number format that a training's products have.

    Args:
        setting: a name of `PRECISIONS`, or `auto`: bfloat16 where the CPU computes in it, else float32.
        device: where the training runs; on a GPU torch runs the GRU, its weights and states in float32.
    """
    if device.type != "cpu":
        return torch.float32
    if setting == "auto":
        found = torch.cpu.get_capabilities()
        return torch.bfloat16 if any(found.get(unit, False) for unit in UNITS) else torch.float32
    return PRECISIONS[setting]


def precision_name(precision: torch.dtype) -> str:
    """Return the name of a number format in the configuration."""
    return next(name for name, dtype in PRECISIONS.items() if dtype == precision)
