"""What trainings are made with, from section `learning` of a configuration.

A job is made again where this code changes; the code of sections is no part of what it rests on.
"""

from mobnet.learning.soap import OptimiserNumbers
from mobnet.settings.networks import Learning


def optimiser_numbers(learning: Learning) -> OptimiserNumbers:
    """Return what the optimiser of a network is made with."""
    return OptimiserNumbers(
        name=learning.optimizer,
        betas=learning.optimizer_betas,
        basis_beta=learning.basis_beta,
        basis_every=learning.basis_every,
    )
