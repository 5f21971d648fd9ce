"""Names in the configuration that must exist elsewhere in it, or on the robot."""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping
from typing import Any

from mobnet.core.errors import ConfigError, not_accepted
from mobnet.core.joints import JointLayout

Use = tuple[str, str, Collection[str]]  # dotted key, name, accepted names


def check_names(config: Mapping[str, Any], layout: JointLayout, where: str = "config") -> None:
    """Check that every scale, level, scenario, terrain, method, limb and joint that is named exists.

    Raises:
        ConfigError: one line with the key, the name and the accepted names.
    """
    for uses in USES:
        for key, name, accepted in uses(config, layout):
            if name not in accepted:
                raise ConfigError(f"{where}: {not_accepted(key, name, accepted)}")


def network_uses(config: Mapping[str, Any], layout: JointLayout) -> Iterator[Use]:
    """Yield the limbs and experiments that networks (Table 1) name."""
    experiments = common_experiments(config)
    for limb, row in config["networks"].items():
        yield f"networks.{limb}.experiment", row["experiment"], experiments
        for key in ("joints", "Q", "T"):
            yield from ((f"networks.{limb}.{key}", group, layout.groups) for group in row.get(key, [limb]))


def method_uses(config: Mapping[str, Any], _: JointLayout) -> Iterator[Use]:
    """Yield the limbs, methods and experiments that methods and sweeps (section 6.3) name."""
    experiments = common_experiments(config)
    sources = [name for name, row in config["methods"].items() if "of" not in row]
    for method, row in config["methods"].items():
        for key in ("limbs", "fitted"):
            yield from ((f"methods.{method}.{key}", limb, config["networks"]) for limb in row.get(key, []))
        yield from ((f"methods.{method}.of", row[key], sources) for key in ("of",) if key in row)
        if "experiment" in row.get("network", {}):
            yield f"methods.{method}.network.experiment", row["network"]["experiment"], experiments
    for name, sweep in config["sweeps"].items():
        yield from ((f"sweeps.{name}.of", method, config["methods"]) for method in sweep["of"])
        yield f"sweeps.{name}.limb", sweep["limb"], config["networks"]
        yield f"sweeps.{name}.experiment", sweep["experiment"], experiments


def common_experiments(config: Mapping[str, Any]) -> set[str]:
    """Return the names of the experiments that every scale has."""
    return set.intersection(*(set(sizes["experiments"]) for sizes in config["scales"].values()))


def scenario_uses(config: Mapping[str, Any], layout: JointLayout) -> Iterator[Use]:
    """Yield what scenarios name, and the joints of pushes."""
    for name, scenario in config["scenarios"].items():
        place = f"scenarios.{name}"
        yield from ((f"{place}.terrain", terrain, config["terrain"]) for terrain in scenario["terrain"])
        yield from ((f"{place}.pushes", push, config["pushes"]) for push in scenario.get("pushes", ()))
        yield from ((f"{place}.motion", scenario[key], config["motions"]) for key in ("motion",) if key in scenario)
        yield f"{place}.draws", scenario.get("draws", name), config["scenarios"]
    for name, row in config["pushes"].items():
        yield from ((f"pushes.{name}.joint", row[key], layout.actuated) for key in ("joint",) if key in row)


def size_uses(config: Mapping[str, Any], _: JointLayout) -> Iterator[Use]:
    """Yield the scale, and the scenarios and levels of tests and training sets."""
    yield "scale", config["scale"], config["scales"]
    for scenario, levels in config["tests"].items():
        yield "tests", scenario, config["scenarios"]
        yield from ((f"tests.{scenario}", level, config["levels"]) for level in levels)
    for name, sizes in config["scales"].items():
        for data, row in sizes["train"].items():
            yield f"scales.{name}.train.{data}.scenario", row["scenario"], config["scenarios"]
            yield f"scales.{name}.train.{data}.level", row["level"], config["levels"]


def evaluation_uses(config: Mapping[str, Any], layout: JointLayout) -> Iterator[Use]:
    """Yield what Figure 5 and the tables and figures of the data name."""
    figure = config["evaluation"]["figure_05"]
    yield from data_uses(config, layout)
    yield "evaluation.figure_05.joint", figure["joint"], layout.names
    yield "evaluation.figure_05.scenario", figure["scenario"], config["scenarios"]
    for level, methods in figure["panels"].items():
        yield "evaluation.figure_05.panels", level, config["levels"]
        yield from ((f"evaluation.figure_05.panels.{level}", method, config["methods"]) for method in methods)


def table_uses(config: Mapping[str, Any], layout: JointLayout) -> Iterator[Use]:
    """Yield what the tables of errors, such as Table 5, and the error budget name."""
    settings = config["evaluation"]
    yield from (("evaluation.windows", scenario, config["scenarios"]) for scenario in settings["windows"])
    tables = {f"tables.{name}": (spec["columns"], spec["rows"]) for name, spec in settings["tables"].items()}
    budget = settings["error_budget"]
    for name, (columns, rows) in (tables | {"error_budget": (budget["joints"], budget["tests"])}).items():
        place, asked = f"evaluation.{name}", [column for column in columns if isinstance(column, Mapping)]
        joints = [column for column in columns if isinstance(column, str)]
        joints += [joint for column in asked for joint in column["joints"]]
        yield from ((f"{place}.joints", joint, (*layout.groups, *layout.names)) for joint in joints)
        metrics = [metric for column in asked for metric in column.get("metrics", ())]
        for row in rows:
            yield from test_uses(place, row, config, layout)
            yield from ((f"{place}.methods", method, config["methods"]) for method in row["methods"])
            if any("push" in metric for metric in (*metrics, row.get("metric", ""))):
                yield f"{place}.scenario, around pushes", row["scenario"], settings["windows"]


def curve_uses(config: Mapping[str, Any], layout: JointLayout) -> Iterator[Use]:
    """Yield what Figures 6 to 10 name."""
    settings = config["evaluation"]
    figures = {name: settings[name] for name in ("figure_06", "figure_07", "figure_08", "figure_09")}
    last = settings["figure_10"]
    figures |= {"figure_10.against": last["against"]}
    figures |= {f"figure_10.tests.{title}": {**test, "joint": last["joint"]} for title, test in last["tests"].items()}
    for name, figure in figures.items():
        place = f"evaluation.{name}"
        yield from test_uses(place, figure, config, layout)
        yield from ((f"{place}.methods", method, config["methods"]) for method in figure["methods"])
        yield from ((f"{place}.joints", joint, layout.names) for joint in figure.get("joints", ()))
        if "limb" in figure:
            yield f"{place}.limb", figure["limb"], layout.groups
        if "joint" in figure:  # of a leg that is pushed
            yield f"{place}.joint", figure["joint"], layout.actuated
            yield f"{place}.scenario, around pushes", figure["scenario"], settings["windows"]


def data_uses(config: Mapping[str, Any], layout: JointLayout) -> Iterator[Use]:
    """Yield what Figure 19 and the tables of the data name."""
    settings = config["evaluation"]
    yield from (("evaluation.figure_19.joints", joint, layout.actuated) for joint in settings["figure_19"]["joints"])
    yield "evaluation.coverage.limb", settings["coverage"]["limb"], config["networks"]
    for test in settings["coverage"]["tests"]:
        yield from test_uses("evaluation.coverage.tests", test, config, layout)
    yield from (("evaluation.uncertainty.ratio", limb, config["networks"]) for limb in settings["uncertainty"]["ratio"])


def ablation_uses(config: Mapping[str, Any], layout: JointLayout) -> Iterator[Use]:
    """Yield what Table 1, Figures 17, 18 and 20 and the overview of methods name."""
    settings = config["evaluation"]
    panels = [{**settings["figure_18"], "scenario": name} for name in settings["figure_18"]["panels"]]
    named = [("table_01.method", [settings["table_01"]["method"]]), ("kinds.variants", settings["kinds"]["variants"])]
    for key, names in (*named, ("figure_17.methods", settings["figure_17"]["methods"])):
        yield from ((f"evaluation.{key}", method, config["methods"]) for method in names)
    for key in ("figure_17", "figure_20"):
        yield f"evaluation.{key}.limb", settings[key]["limb"], config["networks"]
    for key in ("parameters", "samples"):
        yield f"evaluation.figure_20.{key}", settings["figure_20"][key], config["sweeps"]
    for key, tests in (("figure_18", panels), ("methods", settings["methods"])):
        for test in tests:
            yield from test_uses(f"evaluation.{key}", test, config, layout)
            yield from ((f"evaluation.{key}.methods", method, config["methods"]) for method in test["methods"])
            limbs = test.get("columns", test.get("limbs", ()))
            yield from ((f"evaluation.{key}.limbs", limb, layout.groups) for limb in limbs)


def calibration_uses(config: Mapping[str, Any], layout: JointLayout) -> Iterator[Use]:
    """Yield what the calibration of the standard deviations names."""
    settings = config["evaluation"]["calibration"]
    yield "evaluation.calibration.share", settings["share"], settings["levels"]
    yield from (("evaluation.calibration.methods", method, config["methods"]) for method in settings["methods"])
    for test in settings["tests"]:
        place = "evaluation.calibration.tests"
        yield from test_uses(place, test, config, layout)
        yield from ((f"{place}.methods", method, settings["methods"]) for method in test["methods"])
        yield from ((f"{place}.limbs", limb, layout.groups) for limb in test["limbs"])


def test_uses(place: str, test: Mapping[str, Any], config: Mapping[str, Any], layout: JointLayout) -> Iterator[Use]:
    """Yield what a test at a dotted key names: scenario, level and, where one is, the joint that is pushed."""
    yield f"{place}.scenario", test["scenario"], config["scenarios"]
    yield f"{place}.level", test["level"], config["levels"]
    if "pushed" in test:
        yield f"{place}.pushed", test["pushed"], layout.actuated


USES = (
    network_uses, method_uses, scenario_uses, size_uses,
    evaluation_uses, table_uses, curve_uses, ablation_uses, calibration_uses,
)  # fmt: skip
