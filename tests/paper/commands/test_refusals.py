"""A wrong word of a lab's command is refused before anything is imported that starts slowly."""

import json
import subprocess
import sys
from pathlib import Path

import pytest

from experiments.commands.main import run
from experiments.commands.words import parse
from mobnet.core.errors import MobnetError

ARM = Path("tests/data/arm.yaml").resolve()
URDF = Path("tests/data/arm.urdf").resolve()
OF_SETTINGS = {"numpy", "pydantic", "yaml"}  # which there are none of before an environment is made
SLOW = {"torch", "numba", "pinocchio", "mujoco", "scipy", "pyarrow", "matplotlib", "onnx"}
# What words alone tell, with what is said.
BARE = (
    ("learn log --labels none", "--labels: 'none' is not accepted; accepted: feet, free, tool"),
    ("learn log --epochs 0", "--epochs: 0 is not accepted; accepted: a whole number from 1"),
    ("learn empty", "empty: recording.json is missing; accepted: a folder that `./reproduce observe` wrote"),
    ("detect log.csv --thresholds bad.yaml --network empty", "empty: run.json is missing; accepted: a folder that"),
    ("calibrate log --signal sum", "--signal: 'sum' is not accepted; accepted: mean, ratio, std"),
    ("calibrate log --signal ratio", "--signal ratio: it needs --network"),
    ("calibrate log --rate 0", "--rate: 0.0 is not accepted"),
    ("calibrate --recording log/recording", "--estimate: 0 is not accepted; accepted: 1, one for each --recording"),
    ("calibrate", "nothing to calibrate from is given"),
    ("observe log.csv --gain 0", "--gain: 0.0 is not accepted; accepted: a number from 0.1 to 5000"),
    ("observe log.csv --out log.csv/made", "log.csv: cannot be written: "),
    ("motion --seed 0", "--seed: 0 is not accepted; accepted: a whole number from 1 on"),
    ("motion --minutes nan", "--minutes: nan is not accepted; accepted: above 0 and up to 60"),
    ("motion --out log.txt", "--out: ending: '.txt' is not accepted; accepted: .csv, .parquet"),
    ("identify log --out bad.yaml", "bad.yaml: exists already; accepted: another --out, or --force"),
    ("robot arm.urdf --base loose", "--base: 'loose' is not accepted; accepted: fixed, floating"),
    ("robot arm.urdf", "arm.yaml: exists already; accepted: another --out, or --force"),
    ("export log --out made --rate 0", "--rate: 0.0 is not accepted; accepted: a number from 1 to 100000"),
)
# What the configuration, the robot's table or another file of settings tells.
NAMED = (
    ("learn log --robot arm.yaml --limb B", "--limb: 'B' is not accepted; accepted: A"),
    ("learn log", "--limb: 'nothing' is not accepted; accepted: LA, LL, N, RA, RL, V, W"),
    ("calibrate log --robot arm.yaml --limb B", "--limb: 'B' is not accepted; accepted: A"),
    ("learn log --robot bad.yaml", "bad.yaml:2: top level: not YAML"),
    ("motion --robot bad.yaml", "bad.yaml:2: top level: not YAML"),
    ("observe log.csv --robot arm.yaml --map bad.yaml", "bad.yaml:2: top level: not YAML"),
    ("observe log.csv --robot arm.yaml --wrench tail", "--wrench: 'tail' is not accepted; accepted: "),
    ("observe log.csv --robot arm.yaml --wrench wall", "--wrench, what joints of the limb move: 'wall' is not"),
    ("detect log.csv --robot arm.yaml --thresholds bad.yaml", "bad.yaml:2: top level: not YAML"),
    ("identify log --robot arm.yaml --payload tail", "--payload: 'tail' is not accepted; accepted: "),
    ("robot arm.urdf --out new.yaml --torque-limit -5", "--torque-limit: -5.0 is not accepted; accepted: a number"),
    ("robot arm.urdf --out new.yaml --armature nan", "--armature: nan is not accepted; accepted: a number from 0"),
)
CALLS = """import json, sys
from mobnet.commands import main
told = []
for words in json.loads(sys.argv[1]):
    try:
        main(words.split())
    except SystemExit as refused:
        told.append(str(refused.code))
print(json.dumps([told, [name for name in sys.modules if "." not in name]]))
"""


@pytest.fixture(scope="module")
def folder(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A folder of a lab: a robot, a log, what `observe` writes, an empty folder, and a file that is no YAML."""
    made = tmp_path_factory.mktemp("lab")
    for path in (ARM, URDF):
        (made / path.name).symlink_to(path)
    for name in ("log", "empty"):
        (made / name).mkdir()
    for name in ("recording.json", "estimate.json", "recording.parquet"):
        (made / "log" / name).touch()
    (made / "log.csv").touch()
    (made / "bad.yaml").write_text("a: [1\n")
    return made


@pytest.mark.parametrize(("cases", "loaded"), [(BARE, SLOW | OF_SETTINGS), (NAMED, SLOW)])
def test_a_wrong_word_is_refused_before_anything_slow_is_imported(
    cases: tuple[tuple[str, str], ...], loaded: set[str], folder: Path
) -> None:
    words = [sys.executable, "-P", "-c", CALLS, json.dumps([words for words, _ in cases])]
    done = subprocess.run(words, cwd=folder, capture_output=True, text=True, check=True)
    told, modules = json.loads(done.stdout)
    for line, (_, said) in zip(told, cases, strict=True):
        assert said in line
    assert not loaded & set(modules)


@pytest.mark.parametrize(("words", "said"), BARE)
def test_words_alone_are_refused_before_an_environment_is_made(
    words: str, said: str, folder: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.chdir(folder)
    with pytest.raises(MobnetError) as refused:
        run(folder, parse(words.split()))
    assert said in str(refused.value)
    assert not (folder / ".venv").exists()
