"""A command whose reader has seen enough ends without a traceback."""

import subprocess
import sys

CODE = """
import logging
from mobnet.running.printed import printed
printed(logging.getLogger("own"), lambda: (f"line {k}" for k in range(100_000)))
"""


def test_a_closed_pipe_is_no_traceback():
    with subprocess.Popen([sys.executable, "-c", CODE], stdout=subprocess.PIPE, stderr=subprocess.PIPE) as child:
        assert child.stdout.readline() == b"line 0\n"
        child.stdout.close()
        assert child.stderr.read() == b""
    assert child.returncode != 0
