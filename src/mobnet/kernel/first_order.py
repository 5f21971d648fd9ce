"""The recursion of the low-pass, compiled."""

from mobnet.core.arrays import Array
from mobnet.core.compilation import compiled


@compiled
def decay(x: Array, before: Array, pole: float) -> None:
    """Replace samples in x, one after another, by y_k = pole y_{k-1} + (1 - pole) x_k; `before` (width,) is y_{-1}."""
    width = len(before)
    for i in range(min(width, len(x))):
        x[i] = (1.0 - pole) * x[i] + pole * before[i]
    for start in range(width, len(x), width):
        for i in range(start, start + width):
            x[i] = (1.0 - pole) * x[i] + pole * x[i - width]
