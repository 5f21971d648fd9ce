"""The number format of a GRU's matrix products on a CPU: float32, or bfloat16 with float32's range and 8 bits.

Weights, gates and states stay float32; only what goes into a product and comes out of it is rounded.
"""

from __future__ import annotations

from typing import Any

import numpy as np
import torch
from numpy.typing import NDArray
from torch import Tensor

from mobnet.core.errors import ConfigError, not_accepted

PRECISIONS = {"float32": torch.float32, "bfloat16": torch.bfloat16}
UNITS = ("avx512_bf16", "amx_bf16")  # a CPU with one of these multiplies bfloat16 several times faster than float32


def precision_of(setting: str, device: torch.device) -> torch.dtype:
    """Return the number format that a training's products have.

    Args:
        setting: a name of `PRECISIONS`, or `auto`: bfloat16 where the CPU computes in it, else float32.
        device: where the training runs; on a GPU torch runs the GRU, its weights and states in float32.

    Raises:
        ConfigError: the setting is unknown.
    """
    accepted = ("auto", *PRECISIONS)
    if setting not in accepted:
        raise ConfigError(not_accepted("learning.precision", setting, accepted))
    if device.type != "cpu":
        return torch.float32
    if setting == "auto":
        found = torch.cpu.get_capabilities()
        return torch.bfloat16 if any(found.get(unit, False) for unit in UNITS) else torch.float32
    return PRECISIONS[setting]


def precision_name(precision: torch.dtype) -> str:
    """Return the name of a number format in the configuration."""
    return next(name for name, dtype in PRECISIONS.items() if dtype == precision)


def product(a: Tensor, b: Tensor, out: Tensor | None = None) -> Tensor:
    """Return the product (m, n) of two matrices (m, k) and (k, n) of one format; NumPy is the faster one in float32."""
    if a.dtype == torch.float32:
        return torch.from_numpy(np.matmul(a.numpy(), b.numpy(), out=None if out is None else out.numpy()))
    return torch.mm(a, b, out=out)


def memory(tensor: Tensor) -> NDArray[Any]:
    """Return a tensor's memory for compiled loops: float32 as it is, bfloat16, which NumPy lacks, as uint16."""
    return tensor.numpy() if tensor.dtype == torch.float32 else tensor.view(torch.uint16).numpy()
