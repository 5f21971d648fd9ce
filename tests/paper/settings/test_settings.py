"""What follows from the configuration: methods of sweeps, networks with a method's changes, names that are checked."""

import ast
from pathlib import Path

import pytest
from pydantic import ValidationError

from experiments.plan.seeds import FIRST_DEVELOPMENT_SEED, FIRST_TRAINING_SEED
from experiments.settings import evaluation
from experiments.settings.catalogue import Catalogue
from experiments.settings.claims import TAKES, Claim
from experiments.settings.load import load_settings
from experiments.settings.settings import Settings
from mobnet.core.errors import ConfigError
from mobnet.core.notes import Note
from mobnet.formats import reading
from mobnet.formats.base import Section
from mobnet.formats.names import uses
from mobnet.formats.reading import dotted

FOLDERS = (Path(evaluation.__file__).parent, Path(reading.__file__).parent)  # of the experiments, and of the library
# with properties that follow from the values and are never called by a job, or without sections
RESOLVED = {"settings.py", "lab.py", "catalogue.py", "surrogate.py", "robot.py", "reading.py", "load.py", "metrics.py"}
CLAIM = {"printed": "Table 5", "says": "It errs.", "quantity": "ratio", "unit": "-", "published": None}
BOUNDS = {"rule": "bar", "bar": [1.0, 2.0], "sign": [1.0, None]}
WITHOUT = {"quantity": "value", "cells": ["MOB"]}
CAUSE = {"says": "Cold", "since": "2026-11-25", "seen": True, "without": WITHOUT}


def test_a_sweep_stands_for_one_method_for_each_value(settings: Settings) -> None:
    catalogue = Catalogue(settings)
    base, swept = catalogue.method("MOB-Net"), catalogue.method("MOB-Net-hidden-44")
    assert swept == base.model_copy(update={"limbs": ("LL",), "network": {"experiment": "sweep", "hidden": 44}})
    assert catalogue.method("FTS-e2e-data-parts-2").learning == {
        **catalogue.method("FTS-e2e").learning,
        "data_parts": 2,
    }
    sizes = sum(len(sweep.of) * len(sweep.values) for sweep in settings.sweeps.values())
    assert len(catalogue.all_methods) == len(settings.methods) + sizes


def test_a_scale_may_try_fewer_values_of_a_sweep_and_claims_are_about_these() -> None:
    """Their order, and what is no value of a sweep, stay; another scale has them all."""
    few, whole = (load_settings(overrides={"scale": scale}) for scale in ("smoke", "quick"))
    assert whole.sweeps.keys() == few.sweeps.keys()
    for key, row in whole.sweeps.items():
        values = few.scales["smoke"].sweeps.get(key, row.values)
        assert few.sweeps[key] == row.model_copy(update={"values": values})
    made = [f"MOB-Net-hidden-{value}" for value in few.scales["smoke"].sweeps["hidden"]]
    assert [cell.method for cell in few.claims["size-mob-net"].cells] == made
    assert len(whole.claims["size-mob-net"].cells) == 7
    assert [cell.method for cell in few.claims["data-mob-net"].cells][-1] == "MOB-Net-hidden-150"
    assert few.claims["gru-validation"] == whole.claims["gru-validation"]
    assert len(Catalogue(few).all_methods) < len(Catalogue(whole).all_methods)


def test_a_method_changes_its_networks_alone(settings: Settings) -> None:
    catalogue = Catalogue(settings)
    plain, base = (catalogue.network(method, "LL") for method in ("MOB-Net-plain", "MOB-Net"))
    assert plain == base.model_copy(update={"data": "walk_plain"})
    assert base.joints == ("LL",)
    assert catalogue.network("MOB-Net-Single", "WB").joints == settings.robot.networks["WB"].joints


def test_a_method_of_another_runs_on_its_fit_and_on_networks_of_its_own_if_it_has_some(settings: Settings) -> None:
    catalogue = Catalogue(settings)
    assert [catalogue.source_of(name) for name in ("MOB-fric", "MOB-fric-BPF")] == ["MOB-fric", "MOB-fric"]
    assert catalogue.source_of("MOB-Net-gray") == "MOB-fric-load"
    names = ("MOB-Net", "MOB-Net-gray", "MOB-fric-BPF")
    assert [catalogue.network_source_of(name) for name in names] == ["MOB-Net", "MOB-Net-gray", "MOB-fric"]


def test_sizes_lie_over_learning_and_the_methods_changes_over_both(settings: Settings) -> None:
    catalogue = Catalogue(settings)
    learning, sizes = catalogue.training("GRU-printed-rate", "LL").learning, settings.sizes
    assert (learning.batch_size, learning.rate_first) == (sizes.batch_size, 0.05)
    assert learning.std_min == settings.learning.std_min
    assert catalogue.experiment("MOB-Net", "LL") == sizes.experiments["left_leg"]
    assert catalogue.experiment("MOB-Net-hidden-44", "LL") == sizes.experiments["sweep"]


def test_unknown_names_are_refused(settings: Settings) -> None:
    catalogue = Catalogue(settings)
    with pytest.raises(ConfigError, match="method: 'X' is not accepted; accepted: "):
        catalogue.method("X")
    with pytest.raises(ConfigError, match="network: 'tail' is not accepted"):
        catalogue.network("MOB-Net", "tail")
    with pytest.raises(ConfigError, match=r"method to train: 'MOB' is not accepted; accepted: .*MOB-Net"):
        catalogue.training("MOB", "LL")


def test_names_are_looked_at_in_every_section(settings: Settings) -> None:
    """Each mark of a field is found through tuples, keys and values of mappings, unions and nested sections."""
    found = {(dotted(place), kind) for place, kind, _ in uses(settings, Settings)}
    assert found >= {
        ("scale", "scale"), ("scenarios.random_walk.terrain.0", "terrain"), ("scenarios.random_walk.pushes.2", "push"),
        ("scenarios.random_motion.motion", "motion"), ("scenarios.hand_load_10.draws", "scenario"),
        ("pushes.hip_pitch.joint", "motor"), ("detection.place", "scenario without pushes"),
        ("networks.LL.experiment", "experiment"), ("methods.MOB-Net.limbs.0", "network"),
        ("sweeps.hidden.of.1", "method"),
        ("training_sets.walk.scenario", "scenario"), ("training_sets.motion.sizes.smoke", "scale"),
        ("evaluation.tables.table_05.columns.0", "limb or joint"),
        ("evaluation.tables.table_06.columns.2.joints.0", "limb or joint"),
        ("evaluation.tables.table_05.rows.0.methods.0", "method"),
        ("evaluation.figure_05.panels.sensor_noise", "level"),
        ("evaluation.figure_10.tests.swing knee.scenario", "test with a window around pushes"),
        ("evaluation.calibration.tests.2.pushed", "motor"), ("evaluation.figure_18.limbs.0", "limb"),
        ("claims.mob-exact.cells.0.joint", "limb or joint"), ("published.tables.table_05.floor.method", "method"),
    }  # fmt: skip


def test_seeds_of_tests_development_and_training_never_meet(settings: Settings) -> None:
    for scale in settings.scales.values():
        assert scale.test.first_seed + scale.test.shards <= FIRST_DEVELOPMENT_SEED
        assert FIRST_DEVELOPMENT_SEED + scale.development.shards <= FIRST_TRAINING_SEED


def test_seeds_of_the_tests_of_two_scales_never_meet(settings: Settings) -> None:
    seeds: list[int] = []
    for scale in settings.scales.values():
        most = max(scale.test.shards, scale.reactions.pushed.runs, scale.reactions.free.runs)
        seeds += range(scale.test.first_seed, scale.test.first_seed + most)
    assert len(set(seeds)) == len(seeds)


def test_methods_are_chosen_on_walks_that_no_test_has(settings: Settings) -> None:
    for task in settings.development.values():
        row = settings.scenarios[task.scenario]
        assert task.scenario not in Catalogue(settings).tests
        assert row.commands == "uniform"
        assert not row.narrowed.model_fields_set  # uniform over all of Table 2


def test_scenarios_that_draw_the_same_differ_in_pushes_or_random_torque_alone(settings: Settings) -> None:
    own = {"pushes", "random_torque", "draws"}
    for name, row in settings.scenarios.items():
        if row.draws:
            assert row.model_dump(exclude=own) == settings.scenarios[row.draws].model_dump(exclude=own), name


def test_sections_are_frozen_and_closed(settings: Settings) -> None:
    with pytest.raises(ValidationError, match="frozen"):
        settings.plant.contact_friction = 1.0  # type: ignore[misc]
    schema = Settings.model_json_schema()
    closed = [part["additionalProperties"] for part in schema["$defs"].values() if "properties" in part]
    assert len(closed) > 60
    assert not any(closed)


@pytest.mark.parametrize("kind", [Section, Note])
def test_a_class_is_built_when_it_first_checks_a_value(kind: type[Section] | type[Note]) -> None:
    """Building all that a job imports takes a quarter of a second."""

    class Idle(kind):  # type: ignore[misc, valid-type]
        width_m: int

    assert not Idle.__pydantic_complete__
    with pytest.raises(ValidationError, match="Input should be a valid integer"):
        Idle.model_validate({"width_m": "wide"})
    assert Idle.__pydantic_complete__


def test_sections_hold_values_and_checks_and_compute_nothing() -> None:
    """Jobs get values, so the code of sections is no part of their hash: it may hold nothing that a result rests on."""
    for path in (path for folder in FOLDERS for path in folder.glob("*.py")):
        tree = ast.parse(path.read_text())
        for section in (node for node in tree.body if isinstance(node, ast.ClassDef) and path.name not in RESOLVED):
            for method in (node for node in section.body if isinstance(node, ast.FunctionDef)):
                decorators = ast.unparse(method.decorator_list[0]) if method.decorator_list else ""
                is_validator = decorators.startswith(("model_validator", "field_validator"))
                assert is_validator or method.name.endswith("problems"), f"{path}: {method.name}"


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"quantity": "sum"}, r"quantity\n.*'above', 'least ratio'"),
        ({"cells": ["MOB"]}, "1 cells are not accepted; accepted: 2 of 'ratio'"),
        ({"cells": ["MOB"] * 3}, "3 cells are not accepted; accepted: 2 of 'ratio'"),
        ({"cells": [["ideal", "MOB"], "MOB"]}, r"cells.0\n.*valid dictionary"),
        ({"cells": [{"colour": "red"}, "MOB"]}, "colour"),
        ({"bar": [2.0, 1.0]}, "low <= high"),
        ({"claim": "x"}, "claim"),
        ({"bar": None}, "rule 'bar' without `bar` is not accepted"),
        ({"rule": "sign"}, "rule 'sign' with a bar or a number of the paper is not accepted"),
        ({"rule": "sign", "bar": None, "sign": None}, "rule 'sign' without `sign` is not accepted"),
        ({"rule": "about"}, "rule without a number of the paper: 'about' is not accepted"),
        ({"sign": None, "sign_of": WITHOUT}, "`sign_of` without `sign` is not accepted"),
        ({"printed": "not in the paper", "published": 1.5}, "in a claim that is not in the paper is not accepted"),
        ({"cause": CAUSE}, "quantity of a cause: 'value'"),
        ({"cause": {**CAUSE, "since": "yesterday"}}, "since"),
        ({"quantity": "below", "cells": ["MOB"]}, "1 cells are not accepted; accepted: 2, 3, ... of 'below'"),
        ({"quantity": "least ratio", "cells": ["A", "B", "C"]}, "3 cells are not accepted; accepted: 2, 4, ... of"),
    ],
)  # fmt: skip
def test_a_claim_that_does_not_fit_itself_is_refused(change: dict[str, object], message: str) -> None:
    good = {**CLAIM, **BOUNDS, "cells": ["MOB", "MOB-Net"]}
    assert Claim.model_validate(good).cells[1].method == "MOB-Net"
    with pytest.raises(ValidationError, match=message):
        Claim.model_validate({**good, **change})


def test_cells_of_a_claim_share_what_stands_at_it_and_every_quantity_takes_its_cells() -> None:
    cells = [["ideal", "MOB", "LL"], {"method": "A", "level": "no_noise"}]
    entry = {**CLAIM, **BOUNDS, "cells": cells, "at": {"level": "x", "scenario": "s"}}
    first, second = Claim.model_validate(entry).cells
    assert (first.scenario, first.level, first.method, first.joint) == ("s", "ideal", "MOB", "LL")
    assert (second.scenario, second.level) == ("s", "no_noise")
    for quantity, (least, step) in TAKES.items():
        for count in (least, least + step):
            Claim.model_validate({**CLAIM, **BOUNDS, "quantity": quantity, "cells": ["A"] * count})


@pytest.mark.parametrize("scale", ["smoke", "default"])
def test_a_network_of_another_size_is_one_change(scale: str) -> None:
    """Figure 20 shows its size among those that the original tried, which stay."""
    usual = load_settings(overrides={"scale": scale}).sweeps["hidden"].values
    small = load_settings(overrides={"scale": scale, "networks": {"LL": {"hidden": 100}}})
    assert small.sweeps["hidden"].values == tuple(sorted({*usual, 100}))
    assert "MOB-Net-hidden-100" in Catalogue(small).all_methods
