"""What watches limbs all the time: the signals of a detector against thresholds."""

import numpy as np
import pytest

from mobnet.core.estimator import Estimate
from mobnet.core.recording import Sensed
from mobnet.detection.chain import make_chain
from mobnet.detection.signals import Watched
from mobnet.reaction.watchers import LimbWatcher
from mobnet.settings.detection import DetectorSettings

THRESHOLD, TORQUE_NM = 3.0, 12.0


@pytest.mark.parametrize(("std_nm", "ratio"), [(2.0, 2.0), (10.0, 0.4)])
def test_a_limb_is_watched_by_its_torque_over_the_standard_deviation(std_nm, ratio):
    """A network that is less sure of itself, as in a hard step, raises no alarm by the same torque."""
    columns = np.array([4, 5])
    watched = Watched(DetectorSettings(method="MOB-Net", signals=("ratio",)))
    watcher = LimbWatcher(watched, make_chain(15.0, 0.005, 1000.0, np.full((1, 2), THRESHOLD)), columns)
    sample = Sensed(*(np.zeros(5) for _ in Sensed.__dataclass_fields__))
    tau = np.zeros(6)
    tau[5] = -TORQUE_NM
    state = watcher.init()
    found = [watcher.ratio(state, sample, Estimate(tau, np.full(6, std_nm))) for _ in range(500)]
    assert found[0] < found[-1] == pytest.approx(ratio, rel=1e-3)
