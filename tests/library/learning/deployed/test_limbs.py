"""Limb networks side by side."""

import json

import numpy as np
import pytest
from safetensors import safe_open
from safetensors.numpy import save_file

from mobnet.core.errors import DataError
from mobnet.core.files import WEIGHTS
from mobnet.formats.network import Limb
from mobnet.learning.deployed.limbs import LimbNetworks
from mobnet.learning.deployed.loading import load_limb_networks, load_network
from mobnet.learning.deployed.weights import NOTE
from mobnet.learning.features import limb_inputs


@pytest.fixture
def folder(small, tmp_path):
    return small.train(small.training("FTS-e2e", epochs=1), tmp_path)


def test_together_they_predict_what_each_predicts(folder, layout, made_up):
    network, sensed = load_network(folder), made_up(3, 0.1).sensed
    x = limb_inputs(layout, Limb(joints=("LL",), Q=("LL",), T=("LL",)))(sensed)
    both = LimbNetworks([network, network], layout).run_all([sensed])[0]
    np.testing.assert_array_equal(both.mean, np.tile(network.run_all([x])[0].mean, 2))
    np.testing.assert_array_equal(both.std, np.tile(network.run_all([x])[0].std, 2))


def whole(folder, tmp_path, joints):
    """Return the folder of a copy whose note says that it is a network WB of these joints."""
    with safe_open(folder / WEIGHTS, framework="numpy") as file:
        note = {**json.loads(file.metadata()[NOTE]), "limb": "WB", "joints": joints}
        tensors = {name: file.get_tensor(name) for name in file.keys()}  # noqa: SIM118, not a dict
    (tmp_path / "WB").mkdir()
    save_file(tensors, tmp_path / "WB" / WEIGHTS, {NOTE: json.dumps(note)})
    return tmp_path / "WB"


def test_a_network_over_several_limbs_says_its_joints_itself(folder, layout, tmp_path):
    joints = layout.limb("LL")[:3] + layout.limb("RA")[:3]
    assert load_limb_networks({"WB": whole(folder, tmp_path, joints)}, layout).joints == joints


def test_a_network_with_joints_that_the_robot_lacks_is_refused(folder, layout, tmp_path):
    joints = (*layout.limb("LL")[:5], "tail")
    with pytest.raises(DataError, match=r"network of limb 'WB' with joints .* tail; accepted: 'WB' with V1, "):
        load_limb_networks({"WB": whole(folder, tmp_path, joints)}, layout)
