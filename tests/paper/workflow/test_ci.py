""".ci/run installs as root what tests would be skipped without, and hands over to the tests in every case."""

import re
import subprocess
import tomllib
from pathlib import Path

import pytest

from experiments.evaluation.report import paper
from mobnet.simulation import render

ROOT = Path(__file__).parents[3]
RUN = ROOT / ".ci" / "run"
FAKES = {  # program -> what it does in place of the machine's
    "id": "echo {user}",
    "dpkg-query": 'case "${{@: -1}}" in ffmpeg) echo -n installed;; *) exit 1;; esac',
    "apt-get": 'echo "apt-get $*" >> calls; case "$*" in *chromium) exit 100;; *update*) exit {updated};; esac',
}


def packages():
    (block,) = re.findall(r"PACKAGES=\((.*?)\n\)", RUN.read_text(), re.DOTALL)
    return re.sub(r"#.*", "", block).split()


def run(folder, user, updated=0):
    """Return which programs a copy of .ci/run calls, where only ffmpeg is installed, and what it says."""
    for path in ("bin", ".ci"):
        (folder / path).mkdir()
    (folder / ".ci/run").write_text(RUN.read_text())
    (folder / "reproduce").write_text('#!/bin/sh\necho "reproduce $*" >> calls\n')
    for name, text in FAKES.items():
        (folder / "bin" / name).write_text(f"#!/usr/bin/env bash\n{text.format(user=user, updated=updated)}\n")
    for path in (folder / "reproduce", *(folder / "bin").iterdir()):
        path.chmod(0o755)
    environment = {"PATH": f"{folder / 'bin'}:/usr/bin:/bin"}
    words = ["bash", str(folder / ".ci/run"), "-k", "some"]
    done = subprocess.run(words, env=environment, capture_output=True, text=True, check=True)
    return (folder / "calls").read_text().splitlines(), done.stderr


@pytest.mark.parametrize("updated", [0, 100])
def test_root_installs_what_is_missing_and_goes_on_without_what_cannot_be_had(tmp_path, updated):
    calls, told = run(tmp_path, user=0, updated=updated)
    installed = [f"apt-get install -y -qq {package}" for package in packages() if package != "ffmpeg"]
    assert calls == ["apt-get update -qq", *installed, "reproduce test -k some"]
    assert told == ".ci/run: chromium cannot be had, and what needs it is skipped\n"


def test_others_are_told_in_one_line_what_will_be_skipped(tmp_path):
    calls, told = run(tmp_path, user=1000)
    missing = " ".join(package for package in packages() if package != "ffmpeg")
    assert calls == ["reproduce test -k some"]
    assert told == f".ci/run: only root can install what is missing, and what needs it is skipped: {missing}\n"


def test_the_summary_says_what_was_skipped_and_why():
    options = tomllib.loads((ROOT / "pyproject.toml").read_text())["tool"]["pytest"]["ini_options"]["addopts"]
    assert {"-ra", "-rs"}.intersection(options)


def test_packages_are_those_that_the_guide_and_the_code_name():
    named = re.findall(r"\(Debian: ([^)]*)\)", " ".join((ROOT / "docs/guide.md").read_text().split()))
    assert sorted(" ".join(named).split()) == sorted(packages())
    assert {*paper.PACKAGES, *render.PACKAGES.split()} <= set(packages())
