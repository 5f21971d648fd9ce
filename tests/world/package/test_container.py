"""The container: its image can be built and has an environment, and both definitions install what `.ci/run` does."""

import os
import re
import shutil
import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[3]
DOCKERFILE = ROOT / "Dockerfile"
APPTAINER = ROOT / "apptainer.def"
NEEDED = ("buildah", "debootstrap")
# What lets pip find packages on this machine, which need not be the registry: its configuration, and certificates.
PIP_FILES = (Path.home() / ".config/pip", Path("/etc/pip.conf"), Path("/etc/xdg/pip"))
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


def places_of_packages():
    """Return the files and folders that the build must see to install packages as this machine does."""
    files = [path for path in (*PIP_FILES, CERTIFICATES) if path.exists()]
    texts = [value for name, value in os.environ.items() if name.startswith(("PIP_", "UV_"))]
    for path in PIP_FILES:
        texts += [file.read_text() for file in (path, *path.glob("*")) if file.is_file()]
    named = {Path(name) for name in re.findall(r"(?:file://)?(/[\w./+-]+)", "\n".join(texts))}
    # An index is a folder `simple` of links, which lead to files beside it.
    folders = [path.parent if path.name == "simple" else path for path in sorted(named) if path.is_dir()]
    return [*files, *folders]


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

    def run(*words):
        done = subprocess.run([*store, *words], capture_output=True, text=True, check=False)
        assert done.returncode == 0, (done.stdout + done.stderr)[-3000:]
        return done.stdout.strip()

    container = run("from", "scratch")
    run("add", container, str(base), "/")
    run("commit", container, f"docker.io/library/{release.removeprefix('FROM ')}")
    run("rm", container)
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
    for path in places_of_packages():
        inside = Path("/root") / path.relative_to(Path.home()) if path.is_relative_to(Path.home()) else path
        words += ["--volume", f"{path}:{inside}:ro"]
    run(*words, "-t", "mobnet", str(ROOT))
