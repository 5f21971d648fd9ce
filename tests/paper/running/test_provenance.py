"""A result notes the commit and the packages it comes from."""

from pathlib import Path

from mobnet.core.code import commit, provenance


def test_provenance_names_commit_and_lock():
    assert list(provenance()) == ["commit", "lock"]
    assert all(provenance().values())


def test_outside_of_git_and_without_a_lock_both_are_unknown(tmp_path, monkeypatch):
    commit.cache_clear()
    monkeypatch.setattr("mobnet.core.code.ROOT", Path("/"))
    monkeypatch.setattr("mobnet.core.code.LOCK", tmp_path / "environment.lock")
    assert provenance()["commit"] == provenance()["lock"] == "unknown"
    commit.cache_clear()
