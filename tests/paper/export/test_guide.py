"""docs/runtime.md as a reader follows it, whose code begins with the demo of the paper."""

import re
from pathlib import Path

import numpy as np

from experiments.demo import load
from mobnet.export.export import main

ROOT = Path(__file__).parents[3]
PAGE = (ROOT / "docs" / "runtime.md").read_text()


def test_the_page_is_followed_to_the_letter(tmp_path, monkeypatch, capsys):
    (tmp_path / "docs").symlink_to(ROOT / "docs")
    monkeypatch.chdir(tmp_path)
    words = re.search(r"^    \./reproduce export (docs/demo.*)$", PAGE, re.MULTILINE)
    assert main(words[1].split()) == 0
    (code,) = re.findall(r"^```python\n(.*?)^```$", PAGE, re.DOTALL | re.MULTILINE)
    names = {}
    exec(code, names)
    estimator, samples = load("MOB-Net-pushed")
    state = estimator.init()
    for k in range(len(samples)):
        state, wanted = estimator.step(state, samples[k])
    np.testing.assert_allclose(names["estimate"].std, wanted.std, rtol=1e-4)
    assert set(names["estimator"].joints) == set(estimator.joints)
    assert "LL3" in capsys.readouterr().out
