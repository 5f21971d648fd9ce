"""The gates of stacked GRUs: one step for all networks and lanes, forward and back.

K networks run on B lanes each, H units wide. A step forward takes what the products give, W_i x + b_i and W_h h + b_h
(K, B, 3 H) in torch's order reset, update, new, and keeps r, z, n and the state's part of n (K, B, 4 H) for the way
back. That gives the gradients (K, B, 4 H) of the sums: of r and z, of the state's part of n, and of n.
"""

import functools
import logging
from typing import Any, Protocol

import torch
from torch import Tensor

log = logging.getLogger(__name__)
THREADS = 256  # in a block of a GPU
AGREE = 1e-5  # largest difference of kernels from torch, of numbers of the size of 1


class Gates(Protocol):
    """How a step's gates are computed; all numbers are unitless, and outputs are written in place."""

    def forward(self, from_inputs: Tensor, from_state: Tensor, last: Tensor, after: Tensor, kept: Tensor) -> None:
        """Take sums (K, B, 3 H) and the last state (K, B, H); write the state after (K, B, H) and `kept`."""
        ...

    def back(self, later: Tensor, given: Tensor, kept: Tensor, last: Tensor, sums: Tensor, earlier: Tensor) -> None:
        """Take the state's gradient by later steps and by the loss (K, B, H); write that of sums, and what goes on.

        `earlier` (K, B, H) is the gradient of the last state without what passes through the products.
        """
        ...


class TorchGates:
    """The gates in torch's own operations, on any device."""

    def forward(self, from_inputs: Tensor, from_state: Tensor, last: Tensor, after: Tensor, kept: Tensor) -> None:
        """See `Gates`."""
        x_r, x_z, x_n = from_inputs.chunk(3, -1)
        h_r, h_z, h_n = from_state.chunk(3, -1)
        r = (x_r + h_r).sigmoid()
        z = (x_z + h_z).sigmoid()
        n = (x_n + r * h_n).tanh()
        after.copy_(n + z * (last - n))
        kept.copy_(torch.cat([r, z, n, h_n], -1))

    def back(self, later: Tensor, given: Tensor, kept: Tensor, last: Tensor, sums: Tensor, earlier: Tensor) -> None:
        """See `Gates`."""
        d = later + given
        r, z, n, h_n = kept.chunk(4, -1)
        d_n = d * (1 - z) * (1 - n * n)
        d_z = d * (last - n) * z * (1 - z)
        d_r = d_n * h_n * r * (1 - r)
        sums.copy_(torch.cat([d_r, d_z, d_n * r, d_n], -1))
        earlier.copy_(d * z)


# Compiled by NVRTC, which is part of CUDA; a test compiles the same text for a CPU. A jump is the distance between two
# networks in an array [numbers]; a lane has `hidden` units, a network `each` = lanes * hidden.
SOURCE = """
KERNEL void gates_forward(const float *from_inputs, int inputs_jump, const float *from_state, const float *last,
                          float *after, int state_jump, float *kept, int kept_jump, int hidden, int each, int count)
{
    int i = blockIdx.x * blockDim.x + threadIdx.x;
    if (i >= count)
        return;
    int network = i / each;
    int at = i - network * each;
    int lane = at / hidden;
    int unit = at - lane * hidden;
    const float *x = from_inputs + (size_t)network * inputs_jump + (size_t)lane * 3 * hidden + unit;
    const float *h = from_state + (size_t)network * 3 * each + (size_t)lane * 3 * hidden + unit;
    float *keep = kept + (size_t)network * kept_jump + (size_t)lane * 4 * hidden + unit;
    float r = 1.0f / (1.0f + expf(-(x[0] + h[0])));
    float z = 1.0f / (1.0f + expf(-(x[hidden] + h[hidden])));
    float inner = h[2 * hidden];
    float n = tanhf(x[2 * hidden] + r * inner);
    float before = last[(size_t)network * state_jump + at];
    after[(size_t)network * state_jump + at] = n + z * (before - n);
    keep[0] = r;
    keep[hidden] = z;
    keep[2 * hidden] = n;
    keep[3 * hidden] = inner;
}

KERNEL void gates_back(const float *later, const float *given, int given_jump, const float *kept, int kept_jump,
                       const float *last, int state_jump, float *sums, int sums_jump, float *earlier, int hidden,
                       int each, int count)
{
    int i = blockIdx.x * blockDim.x + threadIdx.x;
    if (i >= count)
        return;
    int network = i / each;
    int at = i - network * each;
    int lane = at / hidden;
    int unit = at - lane * hidden;
    const float *keep = kept + (size_t)network * kept_jump + (size_t)lane * 4 * hidden + unit;
    float *sum = sums + (size_t)network * sums_jump + (size_t)lane * 4 * hidden + unit;
    float d = later[i] + given[(size_t)network * given_jump + at];
    float r = keep[0];
    float z = keep[hidden];
    float n = keep[2 * hidden];
    float inner = keep[3 * hidden];
    float before = last[(size_t)network * state_jump + at];
    float d_n = d * (1.0f - z) * (1.0f - n * n);
    sum[0] = d_n * inner * r * (1.0f - r);
    sum[hidden] = d * (before - n) * z * (1.0f - z);
    sum[2 * hidden] = d_n * r;
    sum[3 * hidden] = d_n;
    earlier[i] = d * z;
}
"""
ON_A_GPU = '#define KERNEL extern "C" __global__\n'


class KernelGates:
    """The gates in one kernel each way, on a GPU of NVIDIA."""

    def __init__(self) -> None:
        """Compile the kernels for the current device."""
        compiled: Any = torch.cuda._compile_kernel  # the only door of torch to NVRTC
        self._forward = compiled(ON_A_GPU + SOURCE, "gates_forward")
        self._back = compiled(ON_A_GPU + SOURCE, "gates_back")

    def forward(self, from_inputs: Tensor, from_state: Tensor, last: Tensor, after: Tensor, kept: Tensor) -> None:
        """See `Gates`."""
        arrays = [from_inputs, from_inputs.stride(0), from_state, last, after, after.stride(0), kept, kept.stride(0)]
        _launch(self._forward, [*arrays, *_sizes(after)], after.numel())

    def back(self, later: Tensor, given: Tensor, kept: Tensor, last: Tensor, sums: Tensor, earlier: Tensor) -> None:
        """See `Gates`."""
        arrays = [later, given, given.stride(0), kept, kept.stride(0), last, last.stride(0), sums, sums.stride(0)]
        _launch(self._back, [*arrays, earlier, *_sizes(earlier)], earlier.numel())


def _sizes(state: Tensor) -> list[int]:
    """Return units of a lane, of a network and of all networks of a state (K, B, H)."""
    hidden = state.shape[2]
    return [hidden, state.shape[1] * hidden, state.numel()]


def _launch(kernel: Any, arguments: list[Any], threads: int) -> None:
    kernel(grid=(-(-threads // THREADS), 1, 1), block=(THREADS, 1, 1), args=arguments)


@functools.cache
def gates_of(device: torch.device) -> Gates:
    """Return the gates of a device: kernels on a GPU where they compile and agree with torch, which a warning tells."""
    if device.type != "cuda":
        return TorchGates()
    try:
        gates = KernelGates()
        difference = disagreement(gates, device)
    except Exception as error:  # noqa: BLE001, whatever an installation of CUDA lacks
        log.warning("gates run in torch's operations, which takes longer: no kernel could be compiled: %s", error)
        return TorchGates()
    if not difference < AGREE:
        log.warning("gates run in torch's operations, which takes longer: kernels differ by %.1e", difference)
        return TorchGates()
    return gates


def disagreement(gates: Gates, device: torch.device) -> float:
    """Return the largest difference of gates from torch's operations, of a step of three small networks."""
    lanes, hidden, steps = 5, 7, 2  # of several steps, so that a wrong jump would show
    draw = torch.Generator().manual_seed(1)

    def drawn(*shape: int) -> Tensor:
        return torch.randn(shape, generator=draw).to(device)

    x = drawn(3, steps, lanes, 3 * hidden)[:, 1]
    h = drawn(3, lanes, 3 * hidden)
    states = drawn(3, steps + 1, lanes, hidden)
    given = drawn(3, steps, lanes, hidden)[:, 1]
    later = drawn(3, lanes, hidden)
    gradients: list[Tensor] = []
    for way in (TorchGates(), gates):
        copies = states.clone()
        kept = torch.zeros(3, steps, lanes, 4 * hidden, device=device)
        sums = torch.zeros_like(kept)
        earlier = torch.zeros(3, lanes, hidden, device=device)
        way.forward(x, h, copies[:, 1], copies[:, 2], kept[:, 1])
        way.back(later, given, kept[:, 1], copies[:, 1], sums[:, 1], earlier)
        gradients.append(torch.cat([copies.flatten(), kept.flatten(), sums.flatten(), earlier.flatten()]))
    return float((gradients[0] - gradients[1]).abs().max())
