"""Scripts of rules put the files that a job has in place of their names."""

from pathlib import Path

import pytest

from experiments.jobs.inputs import all_shards, only, place_of, placed, shards, stems
from experiments.plan.parts import MethodRun

RESULTS = Path("results/smoke/robot_1")
ELSEWHERE = "/scratch/7/results/smoke/robot_1"


def test_a_set_has_a_file_for_each_seed() -> None:
    assert shards("a/walk", [1, 2]) == [Path("a/walk/s1"), Path("a/walk/s2")]
    assert all_shards(["a", "b"], [[1, 2], [3]]) == [Path("a/s1"), Path("a/s2"), Path("b/s3")]
    with pytest.raises(ValueError, match="argument 2 is shorter"):
        all_shards(["a", "b"], [[1]])
    assert stems(["motions/a/s1.parquet"]) == [Path("motions/a/s1")]
    assert (only(["a"]), only([])) == (Path("a"), None)


@pytest.mark.parametrize(("name", "file"), [
    ("fits/MOB-fric.json", "fits/MOB-fric.json"),
    ("networks/A-LL-s0", "networks/A-LL-s0/weights.safetensors"),
    ("reactions/knee", "reactions/knee.parquet"),
    ("recordings/walk/a/s1", "recordings/walk/a"),
    ("estimates/walk/a/MOB/n0/s1", "estimates/walk/a"),
])  # fmt: skip
def test_a_name_stands_for_the_job_s_own_file(name: str, file: str) -> None:
    others = [f"{ELSEWHERE}/recordings/walk/b", "/scratch/7/results/smoke/robot_2/fits/MOB-fric.json"]
    assert place_of(RESULTS / name, [*others, f"{ELSEWHERE}/{file}"]) == Path(f"{ELSEWHERE}/{name}")
    assert place_of(RESULTS / name, [*others, str(RESULTS / file)]) == RESULTS / name
    assert place_of(RESULTS / name, others) == RESULTS / name


@pytest.mark.parametrize("root", ["", "/scratch/7/"])
def test_the_end_of_a_longer_path_is_not_the_name(root: str) -> None:
    """The tables of the main scale stand in `tables`, their captions in a folder of this name, too."""
    captions = f"{root}results/default/captions/tables/claims.rst"
    for files in ([captions, f"{root}tables/claims.csv"], [f"{root}tables/claims.csv", captions]):
        assert place_of(Path("tables"), files) == Path(f"{root}tables")
        assert place_of(Path("tables/claims.csv"), files) == Path(f"{root}tables/claims.csv")
        assert place_of(Path("results/default/captions/tables"), files) == Path(captions).parent


def test_names_are_replaced_at_any_depth() -> None:
    run = MethodRun("A", {}, {"LL": RESULTS / "networks/A-LL-s0"}, None, 0, ("LL1",))
    given = {"runs": [run], "pairs": ((RESULTS / "recordings/walk/a/s1", 3),), "text": "results"}
    files = [f"{ELSEWHERE}/networks/A-LL-s0/weights.safetensors", f"{ELSEWHERE}/recordings/walk/a"]
    found = placed(given, files)
    assert found["runs"][0].networks == {"LL": Path(f"{ELSEWHERE}/networks/A-LL-s0")}
    assert found["runs"][0].joints == ("LL1",)
    assert found["pairs"] == ((Path(f"{ELSEWHERE}/recordings/walk/a/s1"), 3),)
    assert found["text"] == "results"
    assert placed(given, []) == given
