"""What a command loads before it has read its flags and the configuration."""

import json
import subprocess
import sys

SLOW = ("numba", "llvmlite", "pinocchio", "pyarrow", "scipy", "matplotlib", "torch")
SCRIPT = """
import json, sys
import mobnet.robotlog.detect
from mobnet.settings.lab import load_lab
load_lab()
print(json.dumps(sorted(set(sys.argv[1:]) & set(sys.modules))))
"""


def test_detect_reads_its_flags_and_the_configuration_before_it_loads_what_starts_slowly():
    done = subprocess.run([sys.executable, "-c", SCRIPT, *SLOW], capture_output=True, text=True, check=True)
    assert json.loads(done.stdout) == []
