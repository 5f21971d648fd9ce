"""Jobs that use a GPU: how many may run at once, and that no two have the same one without knowing."""

import logging
import os

import pytest

from mobnet.core.files import opened, taken
from mobnet.core.machine import claimed, gpus_seen

CUDA, CPU = "2.13.0", "2.13.0+cpu"


def devices_in(folder, names):
    """Make a folder with the files that a driver makes for its devices, besides its own."""
    for name in (*names, "nvidiactl", "null"):
        (folder / name).touch()
    return folder


@pytest.mark.parametrize(("version", "chosen", "names", "seen"), [
    (CUDA, None, [], 0),
    (CUDA, None, ["nvidia0"], 1),
    (CUDA, None, ["nvidia0", "nvidia1", "nvidia10"], 3),
    (CUDA, "1", ["nvidia0", "nvidia1"], 1),
    (CUDA, "0, 1", ["nvidia0", "nvidia1"], 2),
    (CUDA, "0,1,2", ["nvidia0"], 1),
    (CUDA, "GPU-8f3a,GPU-77b1", ["nvidia0", "nvidia1", "nvidia2"], 2),
    (CUDA, "", ["nvidia0"], 0),
    (CUDA, "0,-1,1", ["nvidia0", "nvidia1"], 1),
    (CUDA, None, ["dxg"], 1),
    (CPU, None, ["nvidia0"], 0),
])  # fmt: skip
def test_gpus_are_those_that_torch_can_use(tmp_path, version, chosen, names, seen):
    environment = {} if chosen is None else {"CUDA_VISIBLE_DEVICES": chosen}
    assert gpus_seen(version, environment, devices_in(tmp_path, names)) == seen


def test_each_process_gets_a_gpu_of_its_own_until_there_is_none(tmp_path, caplog):
    names = ["GPU-a", "GPU-b"]
    assert [claimed(names, tmp_path) for _ in names] == [0, 1]  # a second call is as another process
    assert not caplog.records
    with caplog.at_level(logging.WARNING):
        assert claimed(names, tmp_path) == 0
    (warning,) = caplog.messages
    assert "this one shares the GPU GPU-a" in warning


def test_a_gpu_is_free_again_when_its_process_has_ended(tmp_path):
    other = opened(tmp_path / "gpu-a.lock")
    assert taken(other)
    assert claimed(["a", "b"], tmp_path) == 1
    os.close(other)
    assert claimed(["a"], tmp_path) == 0
