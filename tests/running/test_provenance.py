"""A result notes the commit and the packages it comes from."""

from pathlib import Path

from mobnet.running.provenance import commit, provenance


def test_provenance_names_commit_and_lock():
    assert list(provenance()) == ["commit", "lock"]
    assert all(provenance().values())


def test_outside_of_git_and_without_a_lock_both_are_unknown(tmp_path, monkeypatch):
    commit.cache_clear()
    monkeypatch.setattr("mobnet.running.provenance.ROOT", Path("/"))
    monkeypatch.setattr("mobnet.running.provenance.LOCK", tmp_path / "environment.lock")
    assert provenance()["commit"] == provenance()["lock"] == "unknown"
    commit.cache_clear()
