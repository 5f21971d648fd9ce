"""What the rules share: the checked configuration, the names of files, and what each rule depends on."""

import sys
from pathlib import Path

from mobnet.core.code import code_hash
from mobnet.core.config import FIRST_TRAINING_SEED, config_hash, read_yaml, resolve
from mobnet.core.config import check_config as validate
from mobnet.core.environment import quieten
from mobnet.core.errors import MobnetError
from mobnet.core.methods import SCALE_SIZES, experiment_row, network_row, source_of, swept_name
from mobnet.evaluation.report.paper import missing_packages

ROOT = Path(workflow.basedir)
quieten(ROOT)
# Every job, also one that outlives a killed run, holds this lock; ./reproduce clears up only once it holds it alone.
shell.prefix(f"exec 9<>'{ROOT}/.cache/run.lock'; flock -s 9; ")

try:
    validate(config, "configs/config.yaml")
    settings = resolve(config)
    CONTENT = {key: config_hash(read_yaml(Path(settings[key]))) for key in ("robot", "published", "claims")}
except MobnetError as error:
    sys.exit(str(error))

SCALE, SIZES = settings["scale"], settings["sizes"]
MAIN = "default"  # its tables stand where a reader looks for them; other scales have folders of their own
RESULTS = f"results/{SCALE}"
TABLES, FIGURES = ("tables", "figures") if SCALE == MAIN else (f"tables/{SCALE}", f"figures/{SCALE}")
PAPER = "paper" if SCALE == MAIN else f"{RESULTS}/paper"
PDF = [] if missing_packages() else [f"{PAPER}/main.pdf"]  # without TeX there is none
MANIFEST = "results/MANIFEST.sha256" if SCALE == MAIN else f"{RESULTS}/MANIFEST.sha256"
TEST_SEEDS = [1 + i for i in range(SIZES["test"]["shards"])]
TABLE_NAMES = ["table_01", *settings["evaluation"]["tables"], "claims", "data", "steps", "coverage", "uncertainty"]
TABLE_NAMES += ["kinds", "methods", "calibration", "error_budget"]
FIGURE_NAMES = ["figure_05", "figure_06", "figure_07", "figure_08", "figure_09", "figure_10"]
FIGURE_NAMES += ["figure_17", "figure_18", "figure_19", "figure_20", "commands", "calibration"]
BAR_NAMES = ["figure_06", "figure_10"]  # figures whose bars have a file of their own
FIGURE_05, FIGURE_18 = (settings["evaluation"][name] for name in ("figure_05", "figure_18"))


wildcard_constraints:
    scenario="|".join(settings["scenarios"]),
    level="|".join(settings["levels"]),
    method="|".join(settings["methods"]),
    limb="|".join(settings["networks"]),
    motion="|".join(settings["motions"]),
    seed=r"\d+",


def code_of(*rules, method=None):
    """Return the hash of the code behind rules' scripts and, as that is imported by name, behind a method's kind."""
    kinds = [settings["methods"][name]["kind"] for name in method_and_source(method)] if method else []
    modules = [ROOT / "src" / "mobnet" / "estimation" / f"{kind}.py" for kind in kinds]
    scripts = [ROOT / "workflow" / "scripts" / f"{rule}.py" for rule in rules]
    return code_hash(*scripts, *(module for module in modules if module.is_file()))  # the job tells of a missing kind


def method_and_source(method):
    """Return a method and the one that it runs on, if that is another: rows that its estimates depend on."""
    return list(dict.fromkeys([method, source_of(settings, method)]))


def part(*sections, **picked):
    """Return some sections of the configuration, of those `picked` only the entries named.

    A script sees nothing else, so a rule reruns when, and only when, something that it can read has changed.
    """
    few = {section: {name: settings[section][name] for name in names} for section, names in picked.items()}
    return {section: settings[section] for section in sections} | few


def sizes(*names):
    """Return the named sizes of the scale, those that it has."""
    return {"sizes": {name: SIZES[name] for name in names if name in SIZES}}


def training_sizes(method, limb):
    """Return the sizes of the scale that a training depends on."""
    name = network_row(settings, method, limb)["experiment"]
    picked = sizes(*SCALE_SIZES)
    return {"sizes": {**picked["sizes"], "experiments": {name: SIZES["experiments"][name]}}}


def files(kind, ending="parquet"):
    """Return the pattern of a kind's files of one recording."""
    return f"{RESULTS}/{kind}/{{scenario}}/{{level}}/s{{seed}}.{ending}"


def training(kind, name):
    """Return the files of a kind of a training set."""
    row = SIZES["train"][name]
    seeds = [FIRST_TRAINING_SEED + i for i in range(row["shards"])]
    return expand(files(kind), seed=seeds, scenario=row["scenario"], level=row["level"])


def data_of(method, limb):
    """Return the training set that a method's network learns from."""
    return network_row(settings, method, limb)["data"]


def duration_s(scenarios, seed):
    """Return how long the longest recording of some scenarios with a seed is [s]."""
    if int(seed) < FIRST_TRAINING_SEED:
        return SIZES["test"]["shard_s"]
    return max(row["shard_s"] for row in SIZES["train"].values() if row["scenario"] in scenarios)


def motion_of(scenario, seed):
    """Return the file of the upper body's motion in a recording, none if it is still."""
    name = settings["scenarios"][scenario].get("motion")
    return [f"{RESULTS}/motions/{name}/s{seed}.parquet"] if name else []


def motions():
    """Return the files of every motion of the upper body, each once."""
    rows = SIZES["train"].values()
    walked = [(row["scenario"], FIRST_TRAINING_SEED + i) for row in rows for i in range(row["shards"])]
    walked += [(scenario, seed) for scenario in settings["tests"] for seed in TEST_SEEDS]
    return list(dict.fromkeys(name for scenario, seed in walked for name in motion_of(scenario, seed)))


def moved_by(motion):
    """Return the scenarios whose upper body follows a motion."""
    return [name for name, row in settings["scenarios"].items() if row.get("motion") == motion]


def test_recordings():
    """Return the recordings of every test, whether a table shows it yet or not."""
    return [
        name
        for scenario, levels in settings["tests"].items()
        for name in expand(files("recordings"), scenario=scenario, level=levels, seed=TEST_SEEDS)
    ]


def limbs_of(method):
    """Return the limbs whose networks a method uses."""
    return settings["methods"][method].get("limbs", [])


def network_seeds(method, limb=None):
    """Return the seeds of the networks of a method's limb, or, without one, of the limb that has the most; 0 if none."""
    limbs = [limb] if limb else limbs_of(source_of(settings, method))
    return max((experiment_row(settings, method, name)["seeds"] for name in limbs), key=len, default=[0])


def network(method, limb, seed, name="weights.safetensors"):
    """Return a file of a trained network; a limb with fewer seeds than others lends its networks in turn."""
    seeds = network_seeds(method, limb)
    return f"{RESULTS}/networks/{method}-{limb}-s{seeds[int(seed) % len(seeds)]}/{name}"


def networks(name):
    """Return a file of every network that is trained."""
    return [
        network(method, limb, seed, name)
        for method in settings["methods"]
        for limb in limbs_of(method)
        for seed in network_seeds(method, limb)
    ]


def fit_of(method):
    """Return the file that rule `fit` writes for a method, none if it is not fitted without networks."""
    source = source_of(settings, method)
    return [f"{RESULTS}/fits/{source}.json"] if "fitted" in settings["methods"][source] else []


def fitted_to(method, kind):
    """Return limb -> files of a kind of the training set that a method is fitted to."""
    return {limb: training(kind, data_of(method, limb)) for limb in settings["methods"][method].get("fitted", [])}


def fitted_pairs(method):
    """Return limb -> stems of a recording and of its residual, for each of that training set."""
    sets = [fitted_to(method, kind) for kind in ("recordings", "residuals")]
    return {limb: list(zip(*(stems(one[limb]) for one in sets))) for limb in sets[0]}


def network_folders(methods, limb):
    """Return the folders of methods' trained networks of a limb."""
    return [str(Path(network(method, limb, seed)).parent) for method in methods for seed in network_seeds(method, limb)]


def courses(places):
    """Return the files that say how trainings went."""
    return [f"{folder}/{name}" for folder in places for name in ("run.json", "metrics.csv")]


def sizes_of_networks():
    """Return the variations of Figure 20; the network of all data is that of Table 1's size."""
    figure, entries = settings["evaluation"]["figure_20"], []
    limb, full = figure["limb"], figure["parameters"]
    for panel in ("parameters", "samples"):
        key = figure[panel]
        for base in settings["sweeps"][key]["of"]:
            names = [swept_name(base, key, value) for value in settings["sweeps"][key]["values"]]
            if panel == "samples":
                names.append(swept_name(base, full, network_row(settings, base, limb)[full]))
            entries += [{"panel": panel, "base": base, "folders": network_folders([name], limb)} for name in names]
    return entries


def entry(scenario, level, method, network_seed, test_seed):
    """Return one run of a method: what it is, and the stems of its files."""
    place = f"{scenario}/{level}/s{test_seed}"
    return {
        "level": level,
        "method": method,
        "network_seed": network_seed,
        "test_seed": test_seed,
        "recording": f"{RESULTS}/recordings/{place}",
        "residual": f"{RESULTS}/residuals/{place}",
        "estimate": f"{RESULTS}/estimates/{method}/n{network_seed}/{place}",
    }


def entries_of(scenario, level, method):
    """Return the runs of a method on a test: every network on every recording."""
    return [entry(scenario, level, method, seed, test) for seed in network_seeds(method) for test in TEST_SEEDS]


def asked_in(node):
    """Return scenario, level and methods wherever a section of the configuration names these three, at any depth."""
    if isinstance(node, list):
        return [found for item in node for found in asked_in(item)]
    if not isinstance(node, dict):
        return []
    own = (
        [(node["scenario"], node["level"], node["methods"])] if {"scenario", "level", "methods"} <= node.keys() else []
    )
    return own + [found for item in node.values() for found in asked_in(item)]


def wanted():
    """Return scenario, level and method of every run that a table or a figure asks for, each once."""
    found = [(FIGURE_05["scenario"], level, FIGURE_05["panels"][level]) for level in FIGURE_05["panels"]]
    found += [(scenario, FIGURE_18["level"], FIGURE_18["methods"]) for scenario in FIGURE_18["panels"]]
    found += asked_in(settings["evaluation"])
    return list(dict.fromkeys((scenario, level, method) for scenario, level, names in found for method in names))


def runs_of(scenario):
    """Return every run of a scenario that a table or a figure needs."""
    return [run for name, *rest in wanted() if name == scenario for run in entries_of(name, *rest)]


def calibration_tests():
    """Return the tests of the networks' standard deviations, each with its runs."""
    return [
        {
            **test,
            "runs": [run for name in test["methods"] for run in entries_of(test["scenario"], test["level"], name)],
        }
        for test in settings["evaluation"]["calibration"]["tests"]
    ]


def panels_of(figure):
    """Return the runs that a figure of one scenario at some levels shows: first network, first recording."""
    tests = [{**figure, "level": level, "methods": methods} for level, methods in figure["panels"].items()]
    return [run for test in tests for run in first_runs(test)]


def arrays(entries, *kinds):
    """Return the files of some kinds of runs."""
    return list(dict.fromkeys(f"{run[kind]}.parquet" for run in entries for kind in kinds))


def stems(names):
    """Return files without their endings."""
    return [str(Path(name).with_suffix("")) for name in names]


def training_stems(kind, *names):
    """Return training set -> stems of its files of a kind."""
    return {name: stems(training(kind, name)) for name in names}


def exploration_sets():
    """Return the training sets with and without random torque exploration -> stems of their recordings."""
    sets = {"with RTE": "walk", "without RTE": "walk_plain"}
    return {label: stems(training("recordings", name)) for label, name in sets.items()}


def coverage_tests():
    """Return the tests that training data are held against, each with the stems of its recordings."""
    return [
        {**test, "recordings": stems(expand(files("recordings"), seed=TEST_SEEDS, **test))}
        for test in settings["evaluation"]["coverage"]["tests"]
    ]


def coverage_recordings():
    """Return the recordings of those tests."""
    return list(dict.fromkeys(f"{stem}.parquet" for test in coverage_tests() for stem in test["recordings"]))


def shown(name, kind):
    """Mark a file for Snakemake's report, in the category and with the caption of its kind and name."""
    place = f"report/{kind}/{Path(name).stem}.rst"
    title = (ROOT / "workflow" / place).read_text(encoding="utf-8").splitlines()[0]
    return report(
        name, caption=f"../{place}", category=kind.capitalize(), labels={"file": Path(name).stem, "shows": title}
    )


def figure_files(name):
    """Return the files of a figure; the report shows its picture."""
    return [f"{FIGURES}/{name}.pdf", shown(f"{FIGURES}/{name}.png", "figures"), f"{FIGURES}/{name}.csv"]


def scenarios_of_table(name):
    """Return the scenarios whose scores a table shows, each once."""
    return list(dict.fromkeys(row["scenario"] for row in settings["evaluation"]["tables"][name]["rows"]))


def config_of_table(name):
    """Return what a table reads of the configuration: of all tables only its own."""
    picked = part(evaluation=["confidence", "bootstrap_draws"])["evaluation"]
    return part("seed", "robot", "published") | {
        "evaluation": picked | {"tables": {name: settings["evaluation"]["tables"][name]}}
    }


def folders_of_claims():
    """Return the folders of the networks whose losses claims name: all kinds and sizes of the left leg's."""
    kinds = settings["evaluation"]["figure_17"]
    sizes = [folder for size in sizes_of_networks() for folder in size["folders"]]
    return list(dict.fromkeys(network_folders(kinds["methods"], kinds["limb"]) + sizes))


def first_runs(test):
    """Return the runs of a test that a figure shows: first network, first recording."""
    return [
        entry(test["scenario"], test["level"], method, network_seeds(method)[0], TEST_SEEDS[0])
        for method in test["methods"]
    ]


def curves_of(*tests):
    """Return the files behind the curves of tests."""
    return arrays([run for test in tests for run in first_runs(test)], "recording", "residual", "estimate")


def products():
    """Return every file worth keeping, also those that later ones could be made without."""
    scenarios = dict.fromkeys(name for name, _, _ in wanted())
    runs = [run for scenario in scenarios for run in runs_of(scenario)]
    trained = [file for name in ("weights.safetensors", "metrics.csv", "run.json") for file in networks(name)]
    stored = [name for row in SIZES["train"] for name in training("recordings", row)]
    stored += [name for row in SIZES["train"] for name in training("residuals", row)]
    tests = test_recordings() + coverage_recordings()
    stored += list(dict.fromkeys(tests + arrays(runs, "recording", "residual", "estimate"))) + motions()
    notes = [str(Path(name).with_suffix(".json")) for name in stored]
    tables = expand(f"{TABLES}/{{name}}.{{ending}}", name=TABLE_NAMES, ending=["csv", "tex", "md"])
    figures = expand(f"{FIGURES}/{{name}}.{{ending}}", name=FIGURE_NAMES, ending=["pdf", "png", "csv"])
    figures += expand(f"{FIGURES}/{{name}}_bars.csv", name=BAR_NAMES)
    scores = expand(f"{RESULTS}/scores/{{scenario}}.csv", scenario=scenarios)
    fits = list(dict.fromkeys(name for _, _, method in wanted() for name in fit_of(method)))
    texts = [f"{TABLES}/numbers.tex", f"{TABLES}/deviations.tex", f"{PAPER}/build.json", *PDF, f"{RESULTS}/runs.html"]
    return stored + notes + trained + fits + scores + tables + figures + texts


PRODUCTS = products()
