"""The words of ./reproduce: commands, targets, their order and their scale."""

import pytest

from experiments.commands.words import APART, COMMANDS, in_order, parse
from experiments.plan.places import check_scale, scale_of
from mobnet.core.errors import CommandError, ConfigError


@pytest.mark.parametrize(("words", "handed"), [
    (["all", "-n"], ["all", "-n"]),
    (["-n"], ["-n"]),
    (["tables/table_05.tex"], ["tables/table_05.tex", "--config", "scale=default"]),
    (["tables/smoke/table_05.tex", "-n"], ["tables/smoke/table_05.tex", "--config", "scale=smoke", "-n"]),
    (["./results/paper/runs.html"], ["./results/paper/runs.html", "--config", "scale=paper"]),
    (["report.html"], ["report.html"]),
    (
        ["all", "--config", "scale=smoke", "seed=1", "tables/smoke/table_05.tex", "-n"],
        ["all", "tables/smoke/table_05.tex", "--config", "scale=smoke", "seed=1", "-n"],
    ),
    (["tables/smoke/x.md", "--config", "seed=1"], ["tables/smoke/x.md", "--config", "scale=smoke", "seed=1"]),
    (["all", "--config", "scale=smoke", "--", "x.md"], ["all", "--config", "scale=smoke", "--", "x.md"]),
])  # fmt: skip
def test_targets_come_first_and_name_the_scale(words, handed):
    assert parse(words)[::2] == ("all", handed)


@pytest.mark.parametrize("command", APART)
def test_trials_are_targets_of_their_own(command):
    assert parse([command, "--config", "scale=smoke"])[::2] == (command, [command, "--config", "scale=smoke"])


@pytest.mark.parametrize(("words", "message"), [
    *(
        (["all", "--config", "scale=smoke", word], f"--config: '{word}' is not accepted; accepted: KEY=VALUE")
        for word in ("1x=3", "=3", "x=3", "observer.gain_hz=50", "a b=1")
    ),
    (["--config", "seed"], "--config: seed is not accepted; accepted: KEY=VALUE"),
    (["tables/table_05.tex", "tables/smoke/table_05.tex"], "targets of the scales default, smoke: one scale"),
])  # fmt: skip
def test_words_that_name_no_key_or_two_scales_are_refused(words, message):
    with pytest.raises(CommandError, match=message):
        in_order(words)


@pytest.mark.parametrize(("target", "scale"), [
    ("tables/table_05.tex", "default"),
    ("figures/smoke/figure_05.pdf", "smoke"),
    ("results/MANIFEST.sha256", "default"),
    ("./paper/main.pdf", "default"),
    ("results/paper/networks/x", "paper"),
    ("configs/config.yaml", None),
    ("all", None),
])  # fmt: skip
def test_a_path_tells_its_scale(target, scale):
    assert scale_of(target) == scale


def test_a_target_of_another_scale_is_not_accepted():
    check_scale(["-n", "tables/table_05.tex", "results/default/x"], "default")
    with pytest.raises(ConfigError, match="is not made at scale=smoke; accepted: --config scale=default"):
        check_scale(["-n", "tables/table_05.tex"], "smoke")


@pytest.mark.parametrize("words", [["al"], ["clean", "--al"], ["clean", "-a"], ["clean", "all"], ["clean", "--scale"]])
def test_misspelt_words_are_refused(words, capsys):
    with pytest.raises(SystemExit, match="2"):
        parse(words)
    assert words[-1] in capsys.readouterr().err


def test_a_misspelt_command_is_told_with_the_nearest(capsys):
    with pytest.raises(SystemExit, match="2"):
        parse(["cleen"])
    told = capsys.readouterr().err
    assert all(command in told for command in COMMANDS)
    assert "did you mean clean?" in told


@pytest.mark.parametrize("command", COMMANDS)
@pytest.mark.parametrize("word", ["-h", "--help"])
def test_help_of_every_command_does_nothing_else(command, word, capsys):
    with pytest.raises(SystemExit, match="0"):
        parse([command, word])
    assert f"./reproduce {command}" in capsys.readouterr().out
