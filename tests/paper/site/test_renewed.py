"""One command renews the documents that are made, all of them or those that are named."""

import json
import shutil
from pathlib import Path

import pytest

from experiments.site.__main__ import DOCUMENTS, main

ROOT = Path(__file__).parents[3]


def test_a_document_that_is_named_is_renewed_alone(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    shutil.copyfile(ROOT / "CITATION.cff", tmp_path / "CITATION.cff")
    monkeypatch.chdir(tmp_path)
    assert main(["archives"]) == 0
    made = sorted(path.name for path in tmp_path.iterdir())
    assert made == [".zenodo.json", "CITATION.cff", "codemeta.json"]
    assert json.loads((tmp_path / "codemeta.json").read_text()) == json.loads((ROOT / "codemeta.json").read_text())


def test_a_name_of_no_document_is_one_line_before_anything_is_renewed(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, caplog: pytest.LogCaptureFixture
) -> None:
    monkeypatch.chdir(tmp_path)
    assert main(["archives", "mpa"]) == 1
    assert caplog.messages == [
        "document: 'mpa' is not accepted; accepted: map, " + ", ".join(sorted({*DOCUMENTS} - {"map"}))
    ]
    assert list(tmp_path.iterdir()) == []


def test_commands_in_documents_and_tests_name_documents_that_there_are() -> None:
    named = set()
    for part in ("*.md", "docs/**/*.md", "src/experiments/site/*.py", "workflow/report/*.yaml"):
        for path in ROOT.glob(part):
            words = path.read_text().split("python -m experiments.site ")[1:]
            named |= {word.split("`")[0] for word in words}
    assert named == {*DOCUMENTS}
