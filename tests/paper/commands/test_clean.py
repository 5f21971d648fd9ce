"""What ./reproduce clean lists, asks and removes."""

import io

import pytest

from experiments.commands.clean import clean
from experiments.running.one_run import held_folder
from mobnet.core.errors import CommandError

PRODUCTS = ("results/smoke/a.parquet", "tables/t.csv", "tables/smoke/t.csv", "paper/main.pdf", ".snakemake/log/x")
SOURCES = ("tables/.gitignore", "figures/.gitignore", "paper/main.tex", "paper/refs.bib", "src/kept.py", "mine.txt")
ENVIRONMENT = (".venv/bin/python", ".cache/uv/x")


@pytest.fixture
def project(tmp_path):
    """A folder with products, sources and an environment, and without git."""
    for name in (*PRODUCTS, *SOURCES, *ENVIRONMENT):
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text("x")
    return tmp_path


def files(project):
    """Return what is in a folder but its locks."""
    found = (path for path in project.rglob("*") if path.is_file() and path.suffix != ".lock")
    return {str(path.relative_to(project)) for path in found}


def test_products_go_and_sources_stay(project):
    assert clean(project, everything=False, is_dry=False, is_sure=True) == 0
    assert files(project) == {*SOURCES, *ENVIRONMENT}


def test_all_removes_the_environment_too(project):
    assert clean(project, everything=True, is_dry=False, is_sure=True) == 0
    assert files(project) == set(SOURCES)
    assert clean(project, everything=True, is_dry=False, is_sure=True) == 0


def test_dry_run_lists_with_sizes_and_removes_nothing(project, capsys):
    before = files(project)
    (project / "results" / "big").write_bytes(bytes(3_000_000))
    assert clean(project, everything=False, is_dry=True, is_sure=True) == 0
    told = capsys.readouterr().out
    assert "3.0 MB  results\n" in told
    assert "3.0 MB  in all\n" in told
    assert "tables/t.csv" in told
    assert files(project) == before | {"results/big"}


def test_nobody_to_ask_means_no(project, monkeypatch):
    monkeypatch.setattr("sys.stdin", io.StringIO("y\n"))
    before = files(project)
    with pytest.raises(CommandError, match="--yes removes without a question"):
        clean(project, everything=False, is_dry=False, is_sure=False)
    assert files(project) == before


@pytest.mark.parametrize(("answer", "status"), [("y", 0), ("", 1), ("no", 1)])
def test_a_question_is_asked_at_a_terminal(project, monkeypatch, answer, status):
    monkeypatch.setattr("sys.stdin.isatty", lambda: True, raising=False)
    monkeypatch.setattr("builtins.input", lambda: answer)
    assert clean(project, everything=False, is_dry=False, is_sure=False) == status
    assert (project / "results").exists() == bool(status)


def test_a_running_workflow_is_left_alone(project):
    with held_folder(project, ["all"]):
        before = files(project)
        with pytest.raises(CommandError, match="a run goes on in this folder since"):
            clean(project, everything=True, is_dry=False, is_sure=True)
        assert files(project) == before


@pytest.mark.parametrize("name", ["results", "tables", "results/smoke"])
def test_what_a_link_names_stays(project, tmp_path_factory, name):
    elsewhere = tmp_path_factory.mktemp("disk") / "data"
    (project / name).rename(elsewhere)
    (project / name).symlink_to(elsewhere)
    before = files(elsewhere)
    assert clean(project, everything=True, is_dry=False, is_sure=True) == 0
    assert files(elsewhere) == before
