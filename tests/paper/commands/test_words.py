"""The words of ./reproduce: commands, targets and their order; the scale that targets name."""

import re
from pathlib import Path

import pytest

from experiments.commands.main import run
from experiments.commands.words import COMMANDS, GROUPS, TRIALS, in_order, parse
from experiments.running.words import (
    manifest_of,
    nearest,
    one_of,
    results_parser,
    scale_given,
    scale_of,
    scale_of_targets,
)
from mobnet.commands import COMMANDS as LAB
from mobnet.commands import main as lab
from mobnet.core.errors import NEAREST, CommandError, ConfigError
from mobnet.core.options import calibrate_parser, missing_input


@pytest.mark.parametrize(("words", "handed"), [
    (["all", "-n"], ["all", "-n"]),
    (["-n"], ["-n"]),
    (["tables/table_05.tex"], ["tables/table_05.tex"]),
    (["report.html"], ["report.html"]),
    (
        ["all", "--config", "scale=smoke", "seed=1", "tables/smoke/table_05.tex", "-n"],
        ["all", "tables/smoke/table_05.tex", "--config", "scale=smoke", "seed=1", "-n"],
    ),
    (["all", "--config", "scale=smoke", "--", "x.md"], ["all", "--config", "scale=smoke", "--", "x.md"]),
    (
        ["all", "--config", "scale=smoke", "-n", "--config", "seed=3", "tables/smoke/table_05.tex"],
        ["all", "tables/smoke/table_05.tex", "-n", "--config", "scale=smoke", "seed=3"],
    ),
    (["--config=scale=smoke", "all", "-Cseed=3"], ["all", "--config", "scale=smoke", "seed=3"]),
    (["all", "-R", "train", "-n", "--forcerun", "fit"], ["all", "-n", "--forcerun", "train", "fit"]),
    (["all", "-j", "4"], ["all", "-j", "4"]),
])  # fmt: skip
def test_targets_come_first(words, handed):
    assert parse(words)[::2] == ("all", handed)


@pytest.mark.parametrize("words", [["all", "--cores"], ["--jobs", "-n"], ["all", "-c", "--config", "scale=smoke"]])
def test_a_number_of_cores_that_is_missing_is_one_line(words):
    option = next(word for word in words if word in ("--cores", "--jobs", "-c"))
    with pytest.raises(CommandError, match=f"^{option}: its number is missing; accepted: {option} 2, or {option} "):
        parse(words)


def test_the_version_is_that_of_this_project(capsys):
    for word in ("--version", "-v"):
        with pytest.raises(SystemExit, match="0"):
            parse([word])
        assert re.fullmatch(r"mobnet \d+\.\d+\.\d+ \(snakemake 9\.\d+\.\d+\)\n", capsys.readouterr().out)


@pytest.mark.parametrize(("words", "other"), [(["help"], ["--help"]), (["help", "demo"], ["demo", "--help"])])
def test_help_is_a_command_too(words, other, capsys):
    printed = []
    for each in (words, other):
        with pytest.raises(SystemExit, match="0"):
            parse(each)
        printed.append(capsys.readouterr().out)
    assert printed[0] == printed[1] != ""


@pytest.mark.parametrize("word", ["networks", "wandb", "runs"])
def test_a_word_that_is_like_no_command_gets_no_names(word, capsys):
    with pytest.raises(SystemExit, match="2"):
        parse([word])
    line = f"reproduce: command or target: '{word}' is not accepted; ./reproduce --help lists all\n"
    assert capsys.readouterr().err == line


@pytest.mark.parametrize("command", TRIALS)
def test_the_table_of_a_trial_is_a_target(command):
    smoke = ["--config", "scale=smoke"]
    assert parse([command, *smoke])[::2] == (command, [f"results/smoke/trials/{command}.md", *smoke])
    assert parse([command, "-n"]).extra == [f"results/default/trials/{command}.md", "-n"]


@pytest.mark.parametrize(("words", "message"), [
    *(
        (["all", "--config", "scale=smoke", word], f"--config: '{word}' is not accepted; accepted: KEY=VALUE")
        for word in ("1x=3", "=3", "x=3", "observer.gain_hz=50", "a b=1")
    ),
    (["--config", "seed"], "--config: seed is not accepted; accepted: KEY=VALUE"),
])  # fmt: skip
def test_words_that_name_no_key_are_refused(words, message):
    with pytest.raises(CommandError, match=message):
        in_order(words)


@pytest.mark.parametrize(("target", "scale"), [
    ("tables/table_05.tex", "default"),
    ("figures/smoke/figure_05.pdf", "smoke"),
    ("results/MANIFEST.sha256", "default"),
    ("./paper/main.pdf", "default"),
    ("results/paper/networks/x", "paper"),
    ("configs/config.yaml", None),
    ("tables/smoke", None),
    ("results/smoke/", None),
    ("all", None),
])  # fmt: skip
def test_a_path_tells_its_scale(target, scale):
    assert scale_of(target) == scale


def test_targets_name_the_scale():
    assert scale_of_targets(["tables/smoke/table_05.tex", "all"]) == "smoke"
    assert scale_of_targets(["./results/paper/runs.html"]) == "paper"
    assert scale_of_targets(["all"]) is None
    assert scale_of_targets(["all"], "quick") == "quick"
    assert scale_of_targets(["tables/table_05.tex", "results/default/x"], "default") == "default"
    with pytest.raises(ConfigError, match="targets of the scales default, smoke: one scale"):
        scale_of_targets(["tables/table_05.tex", "tables/smoke/table_05.tex"])
    with pytest.raises(ConfigError, match="is not made at scale=smoke; accepted: --config scale=default"):
        scale_of_targets(["tables/table_05.tex"], "smoke")


def test_what_is_no_target_is_told_with_the_nearest():
    known = ["tables/smoke/table_05.tex", "tables/smoke/table_06.tex", "train", "figures"]
    line = "tabels/smoke/table_5.tex: is no target; did you mean tables/smoke/table_05.tex, tables/smoke/table_06.tex, "
    assert nearest("tabels/smoke/table_5.tex", known) == f"{line}train, figures? (the nearest of 4)"


def test_a_wildcard_stands_for_the_names_alone():
    assert re.fullmatch(one_of(["a.b", "c"]), "a.b")
    assert not re.fullmatch(one_of(["a.b", "c"]), "axb")
    assert not re.fullmatch(one_of([]), "")


@pytest.mark.parametrize("words", [["al"], ["clean", "--al"], ["clean", "-a"], ["clean", "all"], ["clean", "--scale"]])
def test_misspelt_words_are_refused(words, capsys):
    with pytest.raises(SystemExit, match="2"):
        parse(words)
    assert words[-1] in capsys.readouterr().err


@pytest.mark.parametrize(("word", "near"), [
    ("cleen", "clean, "),
    ("figure_99", "figures/figure_09.pdf, "),
    ("table_5", "tables/table_05.tex, "),
])  # fmt: skip
def test_a_misspelt_command_is_one_line_with_the_nearest_commands_and_targets(word, near, capsys):
    with pytest.raises(SystemExit, match="2"):
        parse([word])
    told = capsys.readouterr().err
    assert told.startswith(f"reproduce: command or target: '{word}' is not accepted; accepted: {near}")
    assert re.search(r"^[^\n]*(, [^\n]*){4} \(the nearest of \d+\)\n$", told)
    assert told.count(", ") == NEAREST - 1


@pytest.mark.parametrize("columns", [60, 80])
def test_the_help_lists_every_command_in_one_group_and_fits_the_terminal(columns, capsys, monkeypatch):
    monkeypatch.setenv("COLUMNS", str(columns))
    with pytest.raises(SystemExit, match="0"):
        parse(["--help"])
    lines = capsys.readouterr().out.splitlines()
    with pytest.raises(SystemExit, match="0"):
        lab(["--help"])
    lines += capsys.readouterr().out.splitlines()
    assert max(map(len, lines)) <= columns
    listed = [line.split()[0] for line in lines if re.match(r"  \w+ +\w", line)]
    for command in COMMANDS:
        assert listed.count(command) == (2 if command in LAB or command == "demo" else 1), command
    assert all(f"{heading}:" in lines for heading in GROUPS)


def test_the_words_of_cost_are_those_of_a_run():
    smoke = ["--config", "scale=smoke"]
    assert parse(["cost", *smoke, "tables/smoke/table_05.tex"]).extra == ["tables/smoke/table_05.tex", *smoke]
    assert parse(["cost", "docs"]).extra == ["docs"]
    assert parse(["cost", "report"]).extra == ["all"]
    assert parse(["cost", "tuning", *smoke]).extra == ["results/smoke/trials/tuning.md", *smoke]


@pytest.mark.parametrize(("words", "manifest"), [
    ([], "results/MANIFEST.sha256"),
    (["--config", "scale=smoke", "-C", "seed=2"], "results/smoke/MANIFEST.sha256"),
])  # fmt: skip
def test_verify_takes_the_scale_as_a_run_does(words, manifest):
    options = results_parser("verify").parse_args(words)
    assert options.manifest is None
    assert manifest_of(scale_given(options.config)) == Path(manifest)


@pytest.mark.parametrize("command", COMMANDS)
@pytest.mark.parametrize("word", ["-h", "--help"])
def test_help_of_every_command_does_nothing_else(command, word, capsys):
    with pytest.raises(SystemExit, match="0"):
        parse([command, word])
    assert f"./reproduce {command}" in capsys.readouterr().out


@pytest.mark.parametrize(("words", "missing"), [
    (("learn", "logs"), "logs"),
    (("detect", "log.csv", "--thresholds", "limb.yaml"), "log.csv"),
    (("calibrate", "here", "logs", "--limb", "LL"), "logs"),
    (("observe", "here", "--map", "map.yaml"), "map.yaml"),
    (("robot", "arm.urdf"), "arm.urdf"),
])  # fmt: skip
def test_a_lab_s_file_that_is_not_there_is_told_before_anything_is_loaded(words, missing, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    Path("here").touch()
    with pytest.raises(CommandError, match=f"^{missing}: no such file or folder$"):
        run(tmp_path, parse(words))
    with pytest.raises(SystemExit, match=f"^{missing}: no such file or folder$"):
        lab(words)


def test_an_array_may_be_named_without_its_ending(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    for name in ("recording", "estimate"):
        Path(f"{name}.parquet").touch()
    words = ["--recording", "recording", "--estimate", "estimate"]
    assert missing_input(calibrate_parser().parse_args(words)) is None
    assert missing_input(calibrate_parser().parse_args([*words, "--network", "net"])) == "net: no such file or folder"
