"""Words of a call that would do nothing, or something else than they say, by made-up rules and Snakemake's parser."""

import re
from types import SimpleNamespace

import pytest
from snakemake.cli import get_argument_parser

from experiments.plan.targets import OF_RULES, OF_RULES_AND_FILES, faults_of_words, made_line
from experiments.running.words import ALIASES, LISTS, refuse_twice
from mobnet.core.errors import ConfigError

NETWORK = "results/smoke/plant/networks/MOB-Net-RL-s0"
SET = "results/smoke/plant/recordings/walk/ideal"
SHOWN = ["tables/smoke/table_05.csv", "tables/smoke/table_05.tex", "results/smoke/pages/claims.html"]
SCALES = ("smoke", "default")


class Output(str):
    def contains_wildcard(self):
        return "{" in self


def rule(name, *outputs):
    patterns = [re.compile(re.sub(r"\{\w+\}", "[^/]+", re.sub(r"\.", r"\.", output))) for output in outputs]
    made = list(map(Output, outputs))
    return SimpleNamespace(name=name, output=made, is_producer=lambda file: any(p.fullmatch(file) for p in patterns))


RULES = [
    rule("train", "results/smoke/{robot}/networks/{name}/weights.safetensors"),
    rule("collect", "results/smoke/{robot}/recordings/{scenario}/{level}"),
    rule("table", "tables/smoke/{table}.csv", "tables/smoke/{table}.tex"),
    rule("docs", "results/smoke/docs"),
    rule("all"),
    rule("tables"),
]


@pytest.fixture(scope="module")
def parser():
    return get_argument_parser()


@pytest.fixture
def faults(parser):
    def found(*words):
        known, _ = parser.parse_known_args(words)
        return list(faults_of_words(known, RULES, SHOWN, SCALES))

    return found


@pytest.mark.parametrize(("target", "remedy"), [
    (NETWORK, f"{NETWORK}/weights.safetensors"),
    (f"{NETWORK}/", f"{NETWORK}/weights.safetensors"),
    ("tables/smoke", "tables --config scale=smoke, or a file in it"),
    ("tables/smoke/", "tables --config scale=smoke, or a file in it"),
    ("results/smoke", "all --config scale=smoke, or a file in it"),
    ("results", "all, or a file in it"),
    ("results/smoke/pages", "a file in it that a rule makes, such as results/smoke/pages/claims.html"),
])  # fmt: skip
def test_a_folder_is_no_target_and_is_told_with_what_is_one(target, remedy, faults):
    assert faults(target) == [f"{target}: is a folder; accepted: {remedy}"]


def test_what_a_rule_makes_is_a_target_and_other_words_are_told_with_the_nearest(faults):
    assert faults(SET, f"{SET}/", "docs", "tables/smoke/table_06.tex", f"{NETWORK}/weights.safetensors") == []
    (line,) = faults(f"{SET}/s1.parquet")
    assert line.endswith(f"is a file of a set; the target is its folder, {SET}")
    (line,) = faults("trian")
    assert line.startswith("trian: is no target; did you mean train, ")


@pytest.mark.parametrize("words", [
    ("--set-threads", "{}=4"), ("--set-resources", "{}:gpu=1"), ("--groups", "{}=one"), ("--allowed-rules", "{}"),
    ("--consider-ancient", "{}=recordings"), ("--preemptible-rules", "{}"), ("--forcerun", "{}"), ("-R", "{}"),
    ("--until", "{}"), ("--omit-from", "{}"), ("--prioritize", "{}"),
])  # fmt: skip
def test_an_option_with_the_name_of_no_rule_is_told_with_the_nearest(words, faults):
    assert faults(*(word.format("train") for word in words)) == []
    (line,) = faults(*(word.format("trian") for word in words))
    option = ALIASES.get(words[0], words[0])
    assert line.startswith(f"{option}: ")
    assert re.search("trian.* (accepted:|did you mean) train", line)


def test_words_that_snakemake_ignores_are_refused(faults):
    assert faults("--export-cwl", "all.cwl") == [
        "--export-cwl: Snakemake writes no CWL any more and would start the run; leave it out"
    ]
    assert faults("--set-scatter", "split=3") == ["--set-scatter: 'split' is not accepted; accepted: none"]


def test_every_option_that_is_looked_at_is_one_of_snakemake(parser):
    """So that an update of Snakemake tells which is gone, or has come."""
    known = vars(parser.parse_args([]))
    assert {*OF_RULES, *OF_RULES_AND_FILES, "export_cwl", "set_scatter", "targets", "dryrun"} <= known.keys()
    several, others = set(), {}
    for action in parser._actions:
        if action.nargs in ("+", "*") and action.option_strings:
            name = max((f for f in action.option_strings if f in LISTS), default=f"{action.option_strings} is missing")
            several.add(name)
            others |= {flag: name for flag in action.option_strings if flag != name}
    assert several == set(LISTS)
    assert others == ALIASES


@pytest.mark.parametrize(("words", "together"), [
    ("-n --config scale=smoke --config seed=3 all", "--config scale=smoke seed=3 all"),
    ("--config=scale=smoke all -Cseed=3", "--config scale=smoke seed=3"),
    ("--set-threads train=2 -n --set-thr fit=2", "--set-threads train=2 fit=2"),
    ("-R train --forcerun fit", "--forcerun train fit"),
])  # fmt: skip
def test_an_option_of_several_values_that_is_given_twice_is_refused(words, together):
    name = together.split()[0]
    with pytest.raises(ConfigError) as refused:
        refuse_twice(words.split())
    assert str(refused.value) == f"{name}: is given twice, and Snakemake keeps the last alone; accepted: {together}"


ONCE = ("--config a=1 b=2 -R train --until fit", "--profile a --profile b", "--config a=1 -- -C")


@pytest.mark.parametrize("words", ONCE)
def test_an_option_that_is_given_once_is_not(words):
    refuse_twice(words.split())


def test_the_last_line_names_what_was_made():
    folders = SimpleNamespace(results="results/smoke", tables="tables/smoke", figures="figures/smoke", paper="paper")
    assert made_line(["docs"], RULES, folders) == "results/smoke/docs is made"
    assert made_line(["table", "x.tex"], RULES, folders) == "table, x.tex are made"
