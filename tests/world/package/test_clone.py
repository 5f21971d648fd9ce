"""A clone by a git that turns line ends round, as that of Windows does, has the bytes of every file."""

import subprocess
from pathlib import Path

import pytest

from mobnet.core.code import ROOT

pytestmark = pytest.mark.skipif(not (ROOT / ".git").exists(), reason="a tree without git has nothing to clone")


def git(folder: Path, *words: str, given: str = "") -> list[str]:
    """Run git in a folder; return the lines that it prints."""
    done = subprocess.run(["git", *words], cwd=folder, input=given, check=True, capture_output=True, text=True)
    return done.stdout.splitlines()


def test_a_clone_that_turns_line_ends_round_has_the_bytes_of_every_file(tmp_path: Path) -> None:
    clone = tmp_path / "clone"
    git(tmp_path, "clone", "--quiet", "--shared", "-c", "core.autocrlf=true", str(ROOT), str(clone))
    stored: dict[str, str] = {}
    for line in git(clone, "ls-tree", "-r", "HEAD"):
        kind, name = line.split("\t")
        mode, _, digest = kind.split()
        if mode != "120000":  # a link has no lines
            stored[name] = digest
    names = "\n".join(stored)
    hashes = git(clone, "hash-object", "--no-filters", "--stdin-paths", given=names)
    assert dict(zip(stored, hashes, strict=True)) == stored


def test_every_file_that_is_no_text_is_left_as_it_is() -> None:
    """Git tells by the first bytes of a file whether it is a text; a kind of file with others is named."""
    names = git(ROOT, "ls-files")
    found = [name for name in names if (ROOT / name).is_file() and b"\0" in (ROOT / name).read_bytes()]
    assert len(found) > 50
    lines = git(ROOT, "check-attr", "text", "--", *found)
    assert [line for line in lines if not line.endswith("text: unset")] == []
