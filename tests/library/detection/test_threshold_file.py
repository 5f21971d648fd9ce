"""The file of thresholds holds every number as it was, and a wrong one is one line."""

import pytest

from mobnet.core.errors import ConfigError
from mobnet.detection.threshold_file import read_thresholds, write_thresholds
from mobnet.formats.limb_thresholds import LimbThresholds

FOUND = LimbThresholds(
    robot="two-link arm", limb="A", joints=("J1", "J2"), method="MOB-Net", network="12345678e901", signal="ratio",
    thresholds=(3.25, 1.0e-7), watched="always", low_pass_hz=15.0, hold_s=0.005, rate_hz=250.0, gain_hz=100.0,
    torque="sample", rate_per_h=1.0e-5, expected_per_h=1.0, low_per_h=0.0, high_per_h=2.0, confidence=0.95,
)  # fmt: skip


@pytest.mark.parametrize("network", ["12345678e901", "0123456789", None])
def test_what_is_written_is_read(network, tmp_path):
    found = FOUND.model_copy(update={"network": network})
    write_thresholds(tmp_path / "arm.yaml", found)
    assert read_thresholds(tmp_path / "arm.yaml") == found


@pytest.mark.parametrize(("line", "message"), [
    (("thresholds: [3.25, 1.0e-07]", "thresholds: [3.25]"), "1 thresholds for 2 joints; each joint needs one"),
    (("signal: ratio", "signal: rato"), "signal: 'rato' is not accepted; accepted: .*ratio"),
    (("hold_s: 0.005", "hold: 0.005"), "hold"),
])  # fmt: skip
def test_a_wrong_value_is_one_line(line, message, tmp_path):
    path = tmp_path / "arm.yaml"
    write_thresholds(path, FOUND)
    text = path.read_text()
    assert line[0] in text
    path.write_text(text.replace(*line))
    with pytest.raises(ConfigError, match=message):
        read_thresholds(path)
