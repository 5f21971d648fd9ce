"""Training data: the target of section 4.2.3, z-scores, and files that do not fit."""

import tracemalloc
from dataclasses import replace

import numpy as np
import pytest
from library_settings import network_of

from mobnet.core.columns import residual_columns
from mobnet.core.errors import DataError
from mobnet.core.store import read_array, write_array
from mobnet.learning.dataset import load_limb_data, scale_of


@pytest.fixture
def stems(tmp_path, made_up, write_pair):
    return [write_pair(tmp_path, made_up(seed, 1.0 + seed, segments=2)) for seed in (0, 1)]


@pytest.fixture
def load(stems, settings):
    def load(target, rate_hz=None):
        recordings, residuals = zip(*stems, strict=True)
        limb = network_of(settings, "MOB-Net", "LL")
        return load_limb_data(settings.layout, limb, target, recordings, residuals, rate_hz)

    return load


def test_uncertainty_and_external_torque_add_up_to_the_residual(load, stems, layout):
    """The identity of (15): the residual is conserved."""
    total = load("uncertainty").targets + load("external").targets
    residual = np.concatenate([read_array(stem)[0][:, layout.columns(layout.limb("LL"))] for _, stem in stems])
    np.testing.assert_allclose(total, residual, atol=1e-5)


def test_what_foot_sensors_say_is_learned_where_they_label(load, stems, layout):
    """As on a robot: the residual less the label is the target, and the exact torque is not looked at."""
    before, error = load("external").targets, 2.5
    for _, stem in stems:
        array, meta = read_array(stem)
        label = array[:, layout.nv :] + error
        kept = {key: meta[key] for key in ("rate_hz", "segments")}
        columns = residual_columns(layout, labelled=True)
        write_array(stem, np.concatenate([array, label], axis=1), columns, kept, meta["segments"])
    np.testing.assert_allclose(load("external").targets, before + error, atol=1e-4)


def test_recordings_are_laid_end_to_end_and_keep_their_segments(load):
    data = load("uncertainty")
    assert data.segments == ((0, 500), (500, 1000), (1000, 2000), (2000, 3000))
    assert data.inputs.shape == (3000, 30)
    assert data.targets.shape == (3000, 6)


def test_digest_changes_with_any_number(load):
    data, changed = load("uncertainty"), load("uncertainty")
    assert data.digest == load("uncertainty").digest != load("external").digest
    changed.inputs[17, 3] += 1e-3
    assert data.digest != changed.digest


def test_z_scores_come_from_the_given_rows_alone():
    x = np.random.default_rng(0).normal(3.0, 2.0, (1000, 4)).astype(np.float32)
    x[:, 3] = 0.25
    used = np.concatenate([x[:200], x[500:700]])
    scale = scale_of(x, [(0, 200), (500, 700)])
    np.testing.assert_allclose(scale.mean, used.mean(axis=0), rtol=1e-5)
    np.testing.assert_allclose(scale.std[:3], used.std(axis=0)[:3], rtol=1e-5)
    assert scale.std[3] == 1.0


@pytest.mark.parametrize("offset", [0.0, 1e-3, 1e3])
def test_what_rounding_leaves_of_a_constant_column_is_no_signal(offset):
    """Small constants are judged by 1 and large ones by their size."""
    noise = 5e-10 * max(1.0, offset) * np.random.default_rng(0).choice([-1.0, 1.0], (1000, 1))
    assert scale_of(offset + noise, [(0, 1000)]).std[0] == 1.0
    assert scale_of(offset + 10.0 * noise, [(0, 1000)]).std[0] < 1e-5


def test_the_last_recordings_are_held_out(stems, settings):
    limb, columns = network_of(settings, "MOB-Net", "LL"), tuple(zip(*stems, strict=True))
    data = load_limb_data(settings.layout, limb, "external", *columns, held_out=1)
    assert data.held_out == len(read_array(stems[0][0])[0])
    assert data.digest != load_limb_data(settings.layout, limb, "external", *columns).digest


def test_memory_holds_the_data_once_and_what_is_read_of_a_recording(stems, settings):
    limb, pair = network_of(settings, "MOB-Net", "LL"), stems[1]
    one, many = ([[stem] * count for stem in pair] for count in (1, 8))
    load_limb_data(settings.layout, limb, "uncertainty", *one)
    tracemalloc.start()
    data = load_limb_data(settings.layout, limb, "uncertainty", *many)
    most = tracemalloc.get_traced_memory()[1]
    tracemalloc.stop()
    held = data.inputs.nbytes + data.targets.nbytes
    assert most < 1.75 * held


def test_a_missing_column_is_named(stems, load):
    array, meta = read_array(stems[1][1])
    columns = [tuple(column.values()) for column in meta["columns"]]
    others = [(name.replace("tau_ext_lp.LL4", "other.LL4"), unit, frame) for name, unit, frame in columns]
    write_array(stems[1][1], array, others, meta)
    with pytest.raises(DataError, match=r"column 'tau_ext_lp\.LL4' is missing"):
        load("external")


def test_a_residual_of_another_recording_is_refused(stems, settings):
    limb = network_of(settings, "MOB-Net", "LL")
    with pytest.raises(DataError, match=r"residual.*\.json: rows: 2000 is not accepted; accepted: 1000, as in"):
        load_limb_data(settings.layout, limb, "external", [stems[0][0]], [stems[1][1]])


def test_recordings_at_two_rates_or_not_at_that_asked_for_are_refused(stems, load, made_up, write_pair):
    whole = made_up(1, 2.0)
    slow = replace(whole, sensed=whole.sensed[::2], truth=whole.truth[::2], segments=((0, 1000),), rate_hz=500.0)
    stems[1] = write_pair(stems[0][0].parent, slow)
    with pytest.raises(DataError, match=r"\[500.0, 1000.0\] Hz"):
        load("external")
    with pytest.raises(DataError, match=r"\.json: rate_hz: 500.0 is not accepted; accepted: 1000, `rates.data_hz`"):
        load("external", 1000.0)
