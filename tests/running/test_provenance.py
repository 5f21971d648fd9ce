"""A result notes the commit, the packages and the settings it comes from."""

from pathlib import Path

import pytest

from mobnet.running.provenance import commit, provenance


def test_provenance_names_commit_lock_and_config_and_follows_the_settings() -> None:
    assert list(provenance({})) == ["commit", "lock", "config"]
    assert all(provenance({}).values())
    assert provenance({"a": 1, "b": 2}) == provenance({"b": 2, "a": 1})
    assert provenance({"a": 1})["config"] != provenance({"a": 2})["config"]


def test_outside_of_git_and_without_a_lock_both_are_unknown(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    commit.cache_clear()
    monkeypatch.setattr("mobnet.running.provenance.ROOT", Path("/"))
    monkeypatch.setattr("mobnet.running.provenance.LOCK", tmp_path / "environment.lock")
    assert provenance({})["commit"] == provenance({})["lock"] == "unknown"
    commit.cache_clear()
