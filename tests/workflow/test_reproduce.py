"""The entry script: its lock, its words, and how it starts on a bare machine."""

import importlib.util
import re
import subprocess
import sys
from importlib.machinery import SourceFileLoader
from pathlib import Path
from types import ModuleType

import pytest

from .conftest import ROOT


@pytest.fixture(scope="module")
def reproduce() -> ModuleType:
    loader = SourceFileLoader("reproduce_script", str(ROOT / "reproduce"))
    spec = importlib.util.spec_from_loader("reproduce_script", loader)
    assert spec is not None
    module = importlib.util.module_from_spec(spec)
    loader.exec_module(module)
    return module


def test_every_package_but_torch_has_hashes() -> None:
    lines = (ROOT / "environment.lock").read_text().splitlines()
    packages = [line for line in lines if line and line[0] not in " #-"]
    assert [line for line in packages if not line.endswith(" \\")] == ["torch==2.13.0"]
    assert all(re.fullmatch(r"    --hash=sha256:[0-9a-f]{64}( \\)?", line) for line in lines if line.startswith(" "))


def test_constraints_pin_what_they_name() -> None:
    lines = [line for line in (ROOT / "cuda.constraints").read_text().splitlines() if not line.startswith("#")]
    assert all(re.fullmatch(r"[a-z0-9-]+==[0-9.]+", line) for line in lines)


@pytest.mark.parametrize("words", [["--help"], ["-h"]])
def test_help_names_every_command_and_needs_no_environment(words: list[str], reproduce: ModuleType) -> None:
    bare = [sys.executable, "-I", "-S", str(ROOT / "reproduce"), *words]
    done = subprocess.run(bare, capture_output=True, text=True, check=True, env={"PATH": "/usr/bin:/bin"})
    assert all(command in done.stdout for command in reproduce.COMMANDS)


@pytest.mark.parametrize("words", [[], ["al"]])
def test_unknown_command_is_refused(words: list[str]) -> None:
    done = subprocess.run([sys.executable, ROOT / "reproduce", *words], capture_output=True, text=True, check=False)
    assert done.returncode == 2
    assert "command" in done.stderr


def test_pip_configuration_is_handed_to_uv(reproduce: ModuleType, tmp_path: Path) -> None:
    pip = tmp_path / "pip"
    pip.write_text(
        "#!/bin/sh\ncat <<'E'\n:env:.find-links='/a'\nglobal.find-links='/wheels /more'\n"
        "global.extra-index-url='file:///x file:///y'\nglobal.cert='/ca.pem'\nE\n"
    )
    pip.chmod(0o755)
    settings = reproduce.uv_settings([str(pip)])
    assert settings["UV_FIND_LINKS"] == "/wheels,/more"
    assert settings["UV_INDEX"] == "file:///x file:///y"
    assert settings["SSL_CERT_FILE"] == "/ca.pem"


def test_clean_removes_only_what_git_ignores(
    reproduce: ModuleType, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    subprocess.run(["git", "init", "-q", tmp_path], check=True)
    (tmp_path / ".gitignore").write_text("results/\n/tables/*\n!/tables/README.md\n")
    for name in ("results/a.parquet", "tables/t.csv", "tables/README.md", "src/kept.py"):
        (tmp_path / name).parent.mkdir(exist_ok=True)
        (tmp_path / name).write_text("x")
    monkeypatch.setattr(reproduce, "ROOT", tmp_path)
    assert reproduce.clean(everything=False) == 0
    left = {str(path.relative_to(tmp_path)) for path in tmp_path.rglob("*.*") if ".git/" not in str(path)}
    assert left == {".git", ".gitignore", "tables/README.md", "src/kept.py"}


def test_environment_keeps_caches_inside_the_project(reproduce: ModuleType) -> None:
    variables = reproduce.environment()
    assert variables["PATH"].startswith(str(ROOT / ".venv" / "bin"))
    assert variables["OMP_NUM_THREADS"] == "1"
