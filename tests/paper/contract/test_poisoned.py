"""No method reads a force sensor, the ground or anything else of the truth: its estimates stay the same to the bit.

Rules `observe` and `estimate` run on files, as in the workflow, in which all but what is sensed is missing or wrong.
"""

import json
import shutil

import numpy as np
import pyarrow.parquet as pq
import pytest
from paper_settings import settings_at

from experiments.jobs.estimates import estimate
from experiments.jobs.observing import observe
from experiments.plan.parts import MethodRun
from experiments.settings.catalogue import Catalogue
from mobnet.core.columns import EXTERNAL_LP, FEET, SWING, named, recording_columns
from mobnet.core.recording import Truth
from mobnet.core.recording_file import write_recording
from mobnet.core.store import footer_hash, read_array
from mobnet.estimation.kinds import kind_names

LEVEL, SECONDS, WRONG = "all_uncertainty", 0.12, 77.0
METHODS = list(Catalogue(settings_at()).all_methods)


def replaced(stem, names, value=None):
    """Write a number in place of columns of an array on disk, or turn flags around where there is none."""
    path = stem.with_suffix(".parquet")
    table = pq.read_table(path)
    for name in names:
        place = table.schema.get_field_index(name)
        old = table.column(name).to_numpy()
        new = 1.0 - old if value is None else np.full(len(old), value)
        table = table.set_column(place, table.schema.field(name), [new.astype(np.float32)])
    pq.write_table(table, path)
    note = json.loads(path.with_suffix(".json").read_text())
    path.with_suffix(".json").write_text(json.dumps(note | {"footer": footer_hash(path)}))


def observed(settings, folder):
    given = settings.robot, settings.levels[LEVEL], settings.plant.gravity_m_s2, settings.observer
    observe(*given, folder / "recording", folder / "residual")


@pytest.fixture(scope="module")
def truth(layout):
    """Field of the truth -> its columns."""
    return {field: [name for name, *_ in recording_columns(layout)[field]] for field in Truth.__dataclass_fields__}


@pytest.fixture(scope="module")
def folders(settings, made_up, layout, truth, tmp_path_factory):
    """Folders with a recording and its residual: `sound`, `missing` without all that is not sensed, and `wrong`.

    A residual needs the external torque for its label, so that is taken away after the observer. What the plan calls a
    swing ends with a touch-down, which the controller feels, so that is turned around too.
    """
    found = {name: tmp_path_factory.mktemp(name) for name in ("sound", "missing", "wrong")}
    write_recording(found["sound"] / "recording", made_up(6, SECONDS, segments=2), layout)
    for name in ("missing", "wrong"):
        shutil.copytree(found["sound"], found[name], dirs_exist_ok=True)
        replaced(found[name] / "recording", named(SWING, FEET))
    rest = [name for field, names in truth.items() if field != "tau_ext" for name in names]
    replaced(found["missing"] / "recording", rest, np.nan)
    replaced(found["wrong"] / "recording", [name for names in truth.values() for name in names], WRONG)
    for folder in found.values():
        observed(settings, folder)
    replaced(found["missing"] / "recording", truth["tau_ext"], np.nan)
    replaced(found["missing"] / "residual", named(EXTERNAL_LP, layout.names), np.nan)
    return found


@pytest.fixture(scope="module")
def run(settings, learned):
    """A function (method, folder) -> what rule `estimate` writes of the folder's recording; a method learns once."""
    files = {}

    def estimated(method, folder):
        networks, fitted = files[method] = files.get(method) or learned(method)
        given = settings.robot, settings.levels[LEVEL], settings.plant.gravity_m_s2, settings.observer
        runs = [MethodRun(method, Catalogue(settings).all_methods, networks, fitted, 0)]
        estimate(*given, runs, [folder / "recording"], [folder / "residual"], folder / "estimates")
        return read_array(folder / "estimates" / method / "n0" / "recording")[0]

    return estimated


@pytest.mark.parametrize("method", METHODS)
def test_estimates_need_no_force_and_no_truth(method, run, folders):
    sound = run(method, folders["sound"])
    assert np.isfinite(sound).all()
    for name in ("missing", "wrong"):
        np.testing.assert_array_equal(run(method, folders[name]), sound, err_msg=name)


def test_residuals_need_none_either_but_labels_do(layout, folders):
    sound, missing, wrong = (read_residual(folders[name]) for name in ("sound", "missing", "wrong"))
    np.testing.assert_array_equal(missing[:, : layout.nv], sound[:, : layout.nv])
    np.testing.assert_array_equal(wrong[:, : layout.nv], sound[:, : layout.nv])
    assert (wrong[-1, layout.nv :] != sound[-1, layout.nv :]).all()


def read_residual(folder):
    """Return the numbers of the residual of a folder, also those that are missing."""
    table = pq.read_table(folder / "residual.parquet")
    return np.stack([table.column(name).to_numpy() for name in table.column_names], axis=1)


def test_a_poisoned_file_is_really_poisoned(truth, folders):
    """Every column that is not sensed is missing in one and another number in the other."""
    tables = {name: pq.read_table(folder / "recording.parquet") for name, folder in folders.items()}
    for column in (name for names in truth.values() for name in names):
        assert np.isnan(tables["missing"].column(column).to_numpy()).all()
        assert (tables["wrong"].column(column).to_numpy() == WRONG).all()
        assert (tables["sound"].column(column).to_numpy() != WRONG).all()


def test_every_kind_is_among_the_methods(settings):
    assert {row.kind for row in Catalogue(settings).all_methods.values()} == set(kind_names())
