"""How networks learn at the size of the paper."""

import numpy as np

from experiments.settings.catalogue import Catalogue
from mobnet.learning.job import TrainingJob


def test_rate_falls_linearly_to_a_hundredth_over_the_first_half_at_the_papers_size(settings):
    job = TrainingJob(Catalogue(settings.model_copy(update={"scale": "paper"})).training("MOB-Net", "LL"), 0, 0)
    rates = np.array([job.rate(epoch) for epoch in range(200)])
    first = settings.learning.rate_first
    assert rates[0] == first
    np.testing.assert_allclose(np.diff(rates[:101]), -first * 0.99 / 100)
    np.testing.assert_allclose(rates[100:], first / 100)
