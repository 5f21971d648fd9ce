"""Calls of a function that are replayed: on a GPU as one graph, which does not wait for the host at each operation."""

from collections.abc import Callable, Iterator
from contextlib import contextmanager

import torch

WARM_UP = 3  # calls before a graph is captured: libraries take their memory in the first ones


@contextmanager
def in_tf32() -> Iterator[None]:
    """Let a GPU multiply with TF32's 11 bits inside, as cuDNN's GRU does, from float32 into float32.

    Not for an optimiser's bases, which would not be orthogonal then.
    """
    products = torch.backends.cuda.matmul
    before = products.fp32_precision
    products.fp32_precision = "tf32"
    try:
        yield
    finally:
        products.fp32_precision = before


class Replayed:
    """A function of fixed tensors, which it changes in place."""

    def __init__(self, function: Callable[[], None], device: torch.device) -> None:
        """Take a function whose operations, and whose tensors, are the same at each call."""
        self._function = function
        self._device = device
        self._warm = 0
        self._graph: torch.cuda.CUDAGraph | None = None

    def __call__(self) -> None:
        """Call the function; on a GPU it may still be at work afterwards."""
        if self._device.type != "cuda":
            self._function()
        elif self._graph:
            self._graph.replay()
        elif self._warm < WARM_UP:
            self._warm += 1
            self._beside()
        else:
            graph = torch.cuda.CUDAGraph()
            with torch.cuda.graph(graph):
                self._function()
            self._graph = graph
            graph.replay()

    def _beside(self) -> None:
        """Call the function on a stream of its own, as what a graph captures has to have run on one before."""
        current = torch.cuda.current_stream()
        beside = torch.cuda.Stream()
        beside.wait_stream(current)
        with torch.cuda.stream(beside):
            self._function()
        current.wait_stream(beside)
