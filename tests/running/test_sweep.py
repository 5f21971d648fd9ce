"""Of a killed run only unfinished files are removed."""

from experiments.running.environment import sweep


def test_only_unfinished_files_are_removed(tmp_path):
    kept = ["results/a.parquet", "results/.partial.md", "results/.mine.parquet", "configs/.partial.abcdefgh.x"]
    gone = [
        "results/smoke/.partial.ab_12345.s1.parquet", "tables/.partial.abcdefgh.t.csv",
        "results/.partial.abcdefgh.wandb/run", ".snakemake/scripts/tmpabc.train.py",
    ]  # fmt: skip
    for name in (*kept, *gone):
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).touch()
    sweep(tmp_path)
    assert {str(path.relative_to(tmp_path)) for path in tmp_path.rglob("*") if path.is_file()} == set(kept)
