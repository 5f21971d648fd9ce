"""`./reproduce check` accepts what `./reproduce observe` writes, and says of a log who looks at it."""

import re

from experiments.check import main as check
from mobnet.robotlog.observe import main as observe


def test_what_is_written_of_a_log_is_accepted(clean, stored, saying, tmp_path):
    words = ("--robot", "tests/data/arm.yaml", "--wrench", "lower", "--out", tmp_path)
    assert saying(observe, stored(clean[:2000]), *words)[0] == 0
    files = [str(tmp_path / f"{name}.parquet") for name in ("recording", "estimate", "wrench")]
    assert check([*files, "--robot", "tests/data/arm.yaml", "--rate", "1000"]) == 0


def test_a_log_that_is_checked_names_the_command_that_looks_at_it(clean, stored, caplog):
    with caplog.at_level("INFO"):
        assert check([str(stored(clean[:20]))]) == 1
    assert re.search(r"log\.csv: a log; accepted: .*`\./reproduce observe`$", caplog.messages[0])
