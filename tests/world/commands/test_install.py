"""What is installed, how, and how a failure is told in one line."""

import re
import subprocess
import sys
from itertools import pairwise
from pathlib import Path

import pytest

from experiments.commands import install
from experiments.commands import tools as tooling
from experiments.commands.install import wanted_build
from experiments.commands.setup import LOCKS
from experiments.commands.tell import is_unreachable, step_of
from mobnet.core.errors import CommandError

ROOT = Path(__file__).parents[3]
HASH = re.compile(r" {4}--hash=sha256:[0-9a-f]{64}( \\)?")
OFFLINE = "error: Request failed\n  cause: dns error\n"
NOTHING = "error: No solution found\n  cause: torch==2.13.0+cpu has no wheels with a matching tag\n"


@pytest.mark.parametrize("name", LOCKS)
def test_every_package_has_a_version_and_hashes(name):
    lines = [line for line in (ROOT / name).read_text().splitlines() if not line.startswith("#")]
    packages = [line for line in lines if not line.startswith(" ")]
    assert all(re.fullmatch(r"[a-z0-9-]+==[0-9a-z.]+ \\", line) for line in packages)
    assert all(HASH.fullmatch(line) for line in lines if line not in packages)
    assert all(HASH.fullmatch(after) for line, after in pairwise(lines) if line in packages)


def test_torch_has_the_hashes_of_both_builds_for_every_python():
    versions, architectures, builds = 3, 2, 2
    lines = tooling.pinned_lines(ROOT, "torch").splitlines()
    assert len(lines) == 1 + versions * architectures * builds


@pytest.mark.slow
@pytest.mark.parametrize("version", ["3.11", "3.12", "3.13"])
def test_lock_is_complete_for_every_python(version, tmp_path):
    """Nothing is needed beyond the lock, and it has a wheel of everything but one package; needs a registry."""
    tools = tooling.Tools.find(ROOT)
    target = "--python-version", version, "--only-binary", ":all:", "--no-binary", "connection-pool"
    locked = install.locked_packages(ROOT, "cuda"), "-c", str(ROOT / install.CONSTRAINTS)
    words = str(tools.uv), "pip", "install", "--dry-run", "--target", str(tmp_path), "--require-hashes", *target
    output = tools.try_to(*words, "-r", *locked, "--excludes", tooling.written(ROOT, "excludes.txt", "triton\nuv\n"))
    if output and is_unreachable(output):
        pytest.skip("no package registry can be reached")
    assert output is None


@pytest.mark.parametrize(("build", "line"), [("cpu", "torch==2.13.0+cpu \\"), ("cuda", "torch===2.13.0 \\")])
def test_a_build_is_a_version_of_torch(tmp_path, build, line):
    (tmp_path / "environment.lock").write_text((ROOT / "environment.lock").read_text())
    chosen = Path(install.locked_packages(tmp_path, build)).read_text().splitlines()
    assert line in chosen
    assert len(set(chosen) - set((ROOT / "environment.lock").read_text().splitlines())) == 1


def test_cuda_is_chosen_where_a_gpu_is_seen(monkeypatch):
    monkeypatch.setattr("shutil.which", lambda _: "/usr/bin/nvidia-smi")
    assert wanted_build() == "cuda"


def test_pip_configuration_is_handed_to_uv(tmp_path):
    pip = tmp_path / "pip"
    pip.write_text(
        "#!/bin/sh\ncat <<'E'\n:env:.find-links='/a'\nglobal.find-links='/wheels /more'\n"
        "global.extra-index-url='file:///x file:///y'\nglobal.cert='/ca.pem'\nE\n"
    )
    pip.chmod(0o755)
    settings = tooling.uv_settings([str(pip)])
    assert settings["UV_FIND_LINKS"] == "/wheels,/more"
    assert settings["UV_INDEX"] == "file:///x file:///y"
    assert settings["SSL_CERT_FILE"] == "/ca.pem"


@pytest.fixture
def tools(tmp_path, monkeypatch):
    """Tools in a folder with a lock, whose answers a test chooses."""
    (tmp_path / "environment.lock").write_text((ROOT / "environment.lock").read_text())
    monkeypatch.setattr(install, "relocate", lambda _: None)
    return tooling.Tools(tmp_path, sys.executable, (sys.executable, "-m", "pip"), tmp_path / "uv", {})


def answer(monkeypatch, **outputs):
    """Let every call fail with the output under the first name that it has a word of; return the calls."""
    calls = []

    def run(words, stdout, **_):
        calls.append(" ".join(words))
        found = next((text for name, text in outputs.items() if name in calls[-1]), "")
        stdout.write(found)
        return subprocess.CompletedProcess(words, int(bool(found)))

    monkeypatch.setattr(subprocess, "run", run)
    return calls


def test_cpu_is_looked_for_everywhere_before_cuda_is_taken(tools, monkeypatch, capsys):
    calls = answer(monkeypatch, **{"--torch-backend=cpu": OFFLINE, "cpu.txt": NOTHING})
    assert install.install(tools, "cpu", is_asked=False) == "cuda"
    tried = [tuple(word in call for word in ("--offline", "--torch-backend=cpu", "-m pip")) for call in calls]
    assert tried[:5] == [(1, 0, 0), (1, 1, 0), (0, 0, 0), (0, 1, 0), (0, 0, 1)]
    assert "the CUDA build is taken, 6.4 GB in all" in capsys.readouterr().err


def test_cpu_that_is_asked_for_is_not_replaced(tools, monkeypatch):
    answer(monkeypatch, **{"cpu.txt": NOTHING})
    with pytest.raises(CommandError, match=r"cause: torch==2\.13\.0\+cpu has no wheels"):
        install.install(tools, "cpu", is_asked=True)


@pytest.mark.parametrize(("output", "line"), [
    (OFFLINE, "no package registry can be reached; connect to a network"),
    ("WARNING: Temporary failure in name resolution\nERROR: No matching distribution", "no package registry"),
    ("error: failed to copy: No space left on device (os error 28)", "the disk is full"),
    ("error: Hash mismatch for `numpy==2.4.6`", "a package differs from its hash in environment.lock"),
    ("error: Permission denied (os error 13)", "no right to write"),
])  # fmt: skip
def test_a_failure_is_one_line(tools, monkeypatch, output, line):
    answer(monkeypatch, pip=output)
    with pytest.raises(CommandError, match=line) as caught:
        install.install(tools, "cpu", is_asked=False)
    assert "\n" not in str(caught.value)
    assert "then run the same command again" in str(caught.value)


def test_a_terminal_shows_what_a_tool_has_printed_last(tmp_path):
    log = tmp_path / "setup.log"
    log.write_bytes(b"$ before\n")
    start = log.stat().st_size
    assert step_of(log, start) == ""
    log.write_bytes(b"$ before\nResolved 180 packages in 2 s\n Downloaded black\n\n")
    assert step_of(log, start) == "Downloaded black"
    log.write_bytes(b"$ before\nInstalled 180 packages in 4.34s\n")
    assert step_of(log, start) == "Installed 180 packages in 4.34s, compiling them"


def test_every_step_is_a_line_and_its_output_is_kept_in_the_log(tools, capsys):
    tools.run("greeting", "sh", "-c", "echo hello; echo again >&2")
    assert capsys.readouterr().err == "reproduce: greeting\n"
    assert (tools.root / tooling.LOG).read_text().endswith("\nhello\nagain\n")
    with pytest.raises(CommandError, match=r"^greeting failed: error: no \(all output: "):
        tools.run("greeting", "sh", "-c", "echo error: no; exit 3")
