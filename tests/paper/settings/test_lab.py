"""What a lab's commands take of the configuration: the same values as the whole of it, and lines for what is wrong."""

import shutil
import subprocess
import sys

import pytest

from experiments.settings.load import load_settings
from mobnet.core.errors import ConfigError
from mobnet.settings.lab import CONFIGS, Lab, load_lab

MOST_MODULES = 7  # of settings, that a command of a lab loads; packages are not counted
LOADED = """import sys
import mobnet.{}
own = [module for name, module in sys.modules.items() if name.partition(".")[0] in ("mobnet", "experiments")]
print(*(module.__name__ for module in own if not hasattr(module, "__path__")))
"""
COMMANDS = ("robotlog.motion", "robotlog.observe", "robotlog.identify", "robotlog.learn", "detection.calibrate",
            "robotlog.detect", "robot.import_table", "export.export")  # fmt: skip


@pytest.fixture
def configs(tmp_path):
    """A copy of the configuration."""
    return shutil.copytree(CONFIGS, tmp_path / "configs")


def replace(path, old, new):
    text = path.read_text()
    assert old in text
    path.write_text(text.replace(old, new))


def test_values_are_those_of_the_whole_configuration():
    lab, settings = load_lab(), load_settings()
    assert isinstance(settings, Lab)
    assert {name: getattr(lab, name) for name in Lab.model_fields} == {
        name: getattr(settings, name) for name in Lab.model_fields
    }


@pytest.mark.parametrize(
    ("file", "old", "new", "said"),
    [
        ("detection", "hold_s: 0.005", "hold_s: 5", r"detection\.yaml:\d+: detection\.hold_s: 5 is not accepted; "),
        ("plant", "gravity_m_s2:", "gravity:", r"plant\.yaml:\d+: plant\.gravity: "),
        ("config", "robot: configs", "robot: cfg", r"config\.yaml:\d+: robot: 'cfg\S+' is not accepted; "),
        ("robots/tocabi", "\nname:", "\nnom:", r"tocabi\.yaml:\d+: nom: "),
    ],
)  # fmt: skip
def test_a_fault_is_a_line_with_its_place(configs, file, old, new, said):
    replace(configs / f"{file}.yaml", old, new)
    with pytest.raises(ConfigError, match=said):
        load_lab(configs)


def test_a_fault_of_an_experiment_is_none_of_a_lab(configs):
    for name in ("claims", "evaluation", "scales", "data"):
        (configs / f"{name}.yaml").write_text("a: [1\n")
    assert load_lab(configs) == load_lab()


@pytest.mark.parametrize("command", COMMANDS)
def test_a_command_of_a_lab_loads_no_experiment(command):
    words = [sys.executable, "-c", LOADED.format(command)]
    names = subprocess.run(words, capture_output=True, text=True, check=True).stdout.split()
    assert [name for name in names if name.startswith("experiments")] == []
    assert sum(name.startswith("mobnet.settings.") for name in names) <= MOST_MODULES
