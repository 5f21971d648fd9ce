"""The container: its image can be built and has an environment, and both definitions install what `.ci/run` does."""

import ast
import os
import re
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from experiments.commands.tools import find_pip

ROOT = Path(__file__).parents[3]
BASE = getattr(sys, "_base_executable", sys.executable)  # that of .venv has no pip
DOCKERFILE = ROOT / "Dockerfile"
APPTAINER = ROOT / "apptainer.def"
NEEDED = ("buildah", "debootstrap")
VARIABLES = ":env:"  # section of what pip takes from variables PIP_*
# What lets pip find packages on this machine, which need not be the registry, whoever runs the test and from wherever.
KEYS = (
    "index-url",
    "extra-index-url",
    "find-links",
    "no-index",
    "trusted-host",
    "constraint",
    "cert",
    "default-timeout",
)
CERTIFICATES = Path("/etc/ssl/certs/ca-certificates.crt")
CHECKS = """
RUN ./reproduce --help
RUN .venv/bin/python -c "import mobnet, torch, mujoco, pinocchio, snakemake"
RUN test -z "$(git ls-files --deleted)"
"""


def installed(path):
    """Return the packages that a definition installs, those of its arguments included."""
    text = path.read_text().replace("\\\n", " ")
    extras = re.search(r'^ARG EXTRAS="(.*)"$', text, re.MULTILINE)
    line = re.search(r"apt-get install -y --no-install-recommends ([^&\n]*)", text, re.MULTILINE)[1]
    return sorted(line.replace("$EXTRAS", extras[1] if extras else "").split())


def pip_settings(text):
    """Return where packages come from, by key, of what `pip config list` prints; variables come before files."""
    files, variables = {}, {}
    for section, key, value in re.findall(r"^(\S+)\.([a-z-]+)=('.*'|\".*\")$", text, re.MULTILINE):
        if key in KEYS:
            found = variables if section == VARIABLES else files
            found[key] = ast.literal_eval(value)
    return {**files, **variables}


def pip_file(settings):
    """Return a configuration of pip that says the same, and no other variable or file need reach the build."""
    lines = [f"{key} = {' '.join(value.split())}" for key, value in settings.items()]
    return "\n".join(["[global]", *lines, ""])


def places_of_packages(settings):
    """Return the files and folders that the build must see to install packages as this machine does."""
    named = {Path(name) for name in re.findall(r"(?:file://)?(/[\w./+-]+)", "\n".join(settings.values()))}
    # An index is a folder `simple` of links, which lead to files beside it.
    places = [path.parent if path.name == "simple" else path for path in sorted({*named, CERTIFICATES})]
    return [path for path in places if path.exists()]


def test_both_definitions_install_the_same_and_tests_need_nothing_more_than_they_do():
    assert installed(DOCKERFILE) == installed(APPTAINER)
    ci = (ROOT / ".ci" / "run").read_text()
    (block,) = re.findall(r"PACKAGES=\((.*?)\n\)", ci, re.DOTALL)
    known = set(re.sub(r"#.*", "", block).split())
    assert set(installed(DOCKERFILE)) - known == {"ca-certificates", "git", "python3-venv"}


def test_an_image_takes_what_git_tracks_and_nothing_that_is_made():
    told = (ROOT / ".gitignore").read_text().split()
    kept = [line for line in (ROOT / ".dockerignore").read_text().splitlines() if not line.startswith("#")]
    for line in told:
        name = line.strip("/")
        assert {name, f"/{name}", f"**/{name}", f"!{name[1:].strip('/')}"} & set(kept), line
    for folder in ("tables", "figures"):
        assert f"!/{folder}/.gitignore" in kept


def test_the_build_gets_packages_as_this_machine_does_by_variables_as_by_files(tmp_path):
    """An index that a variable names comes before that of a file; its folder and the file of constraints are seen."""
    for name in ("simple", "wheels"):
        (tmp_path / name).mkdir()
    (tmp_path / "constraints.txt").touch()
    told = f""":env:.cache-dir='/somewhere'
:env:.index-url='file://{tmp_path}/simple'
global.constraint='{tmp_path}/constraints.txt'
global.find-links='\\n{tmp_path}/wheels\\nhttps://example.org/wheels'
global.index-url='https://example.org/simple'
"""
    settings = pip_settings(told)
    assert pip_file(settings).splitlines() == [
        "[global]",
        f"constraint = {tmp_path}/constraints.txt",
        f"find-links = {tmp_path}/wheels https://example.org/wheels",
        f"index-url = file://{tmp_path}/simple",
    ]
    assert set(places_of_packages(settings)) - {CERTIFICATES} == {
        tmp_path, tmp_path / "wheels", tmp_path / "constraints.txt",
    }  # fmt: skip


@pytest.mark.slow
def test_the_image_can_be_built_and_has_its_environment(tmp_path):
    missing = [name for name in NEEDED if not shutil.which(name)]
    if missing or os.geteuid() != 0:
        pytest.skip(f"a container needs root and Debian's {' and '.join(NEEDED)}; missing: {missing or ['root']}")
    (release,) = re.findall(r"^FROM debian:12$", DOCKERFILE.read_text(), re.MULTILINE)
    base = tmp_path / "base"
    # The machine's certificates lie over those of this package in the build, where it could not install its own.
    packages = ["--variant=minbase", "--include=ca-certificates"]
    made = subprocess.run(["debootstrap", *packages, "bookworm", str(base)], capture_output=True, text=True)
    if made.returncode:
        pytest.skip(f"Debian's packages cannot be had here: {made.stdout.splitlines()[-1:]}")
    store = [
        "buildah",
        "--storage-driver",
        "vfs",
        "--root",
        str(tmp_path / "store"),
        "--runroot",
        str(tmp_path / "run"),
    ]

    # Of this machine's variables none that pip or uv would read.
    variables = {name: value for name, value in os.environ.items() if not name.startswith(("PIP_", "UV_"))}

    def run(*words):
        done = subprocess.run([*store, *words], env=variables, capture_output=True, text=True, check=False)
        assert done.returncode == 0, (done.stdout + done.stderr)[-3000:]
        return done.stdout.strip()

    container = run("from", "scratch")
    run("add", container, str(base), "/")
    run("commit", container, f"docker.io/library/{release.removeprefix('FROM ')}")
    run("rm", container)
    shutil.rmtree(base)  # the store has it, and holds each layer whole
    # TeX and pictures are left out: they take minutes, and .ci/run has installed the same packages on this machine.
    checked = tmp_path / "Dockerfile"
    checked.write_text(DOCKERFILE.read_text() + CHECKS)
    words = [
        "bud",
        "--isolation",
        "chroot",
        "--pull-never",
        "--layers=false",
        "--build-arg",
        "EXTRAS=",
        "-f",
        str(checked),
    ]
    told = subprocess.run([*find_pip(ROOT, BASE), "config", "list"], capture_output=True, text=True, check=True).stdout
    settings = pip_settings(told)
    configured = tmp_path / "pip.conf"
    configured.write_text(pip_file(settings))
    words += ["--volume", f"{configured}:/etc/pip.conf:ro"]
    for path in places_of_packages(settings):
        words += ["--volume", f"{path}:{path}:ro"]
    run(*words, "-t", "mobnet", str(ROOT))
