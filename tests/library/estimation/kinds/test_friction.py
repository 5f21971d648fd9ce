"""The friction model of MOB-fric obeys (23) and corrects the residual by its filtered torque."""

import json

import numpy as np
import pytest
from library_settings import network_of

from mobnet.core.joints import N_VIRTUAL
from mobnet.estimation.kinds.friction import FittedFriction, FrictionModel, Options, build, fit, read_friction
from mobnet.estimation.regression import TERMS
from mobnet.kernel.low_pass import low_pass
from mobnet.simulation.friction import friction_torque, make_friction

GAIN_HZ, RATE_HZ = 100.0, 1000.0
KNEE = {"coulomb_nm": 12.0, "static_nm": 9.0, "viscous_nms": 3.0, "load_per_nm": 0.002, "stribeck_rad_s": 0.3}


@pytest.fixture
def fitted(tmp_path):
    """A fit of the left knee alone."""
    path = tmp_path / "fit.json"
    path.write_text(json.dumps({"smoothing_rad_s": 0.02, "joints": {"LL4": KNEE}}))
    return path


@pytest.fixture
def plant(settings, layout):
    """Friction of the plant with Table 4's numbers."""
    legs = np.array([joint[1] == "L" for joint in layout.actuated])
    return make_friction(settings.plant, legs, ["stribeck", "load"])


@pytest.fixture
def table_4(plant, layout):
    """The same in the form of the fit."""
    dry = {"coulomb": np.full(layout.nu, plant.coulomb), "static": np.full(layout.nu, plant.static)}
    terms = {**dry, "viscous": plant.viscous, "load": plant.load}
    return FittedFriction(terms, np.full(layout.nu, plant.stribeck), plant.smoothing)


def test_it_has_the_plants_form(plant, layout, table_4):
    rng = np.random.default_rng(0)
    velocity, torque = rng.normal(0, 1, (20, layout.nu)), rng.normal(0, 50, (20, layout.nu))
    expected = [
        [friction_torque(plant, j, v, tau) for j, (v, tau) in enumerate(zip(vs, taus, strict=True))]
        for vs, taus in zip(velocity, torque, strict=True)
    ]
    np.testing.assert_allclose(table_4.torque(velocity, torque), expected, rtol=1e-12)


def test_prediction_is_the_filtered_torque_and_the_base_has_none(layout, table_4, made_up):
    sensed = made_up(2, 0.2).sensed
    prediction = FrictionModel(layout, table_4, GAIN_HZ, RATE_HZ).run_all([sensed])[0]
    torque = table_4.torque(sensed.v[:, N_VIRTUAL:], sensed.tau_motor)
    assert prediction.std is None
    assert not prediction.mean[:, :N_VIRTUAL].any()
    np.testing.assert_allclose(prediction.mean[:, N_VIRTUAL:], low_pass(torque, GAIN_HZ, RATE_HZ), rtol=1e-12)


def test_joints_that_were_not_fitted_are_those_of_the_observer(changed_joints, fitted):
    assert changed_joints(build, "MOB-fric", fitted) == ["LL4"]


def test_numbers_are_read_by_name(fitted, layout):
    friction, knee = read_friction(fitted, layout.actuated), layout.actuated.index("LL4")
    assert {key: friction.terms[term][knee] for term, key in TERMS.items()} == {
        key: KNEE[key] for key in TERMS.values()
    }
    assert friction.stribeck[knee] == KNEE["stribeck_rad_s"]
    assert sum(np.count_nonzero(factors) for factors in friction.terms.values()) == len(TERMS)


def test_load_needs_a_limb_whose_network_sees_the_torque(settings, made_up, write_pair, tmp_path):
    """Section 4.2.2: load-dependent friction in the legs alone."""
    pair, layout, limbs = write_pair(tmp_path, made_up(3, 1.0)), settings.layout, ("LA", "LL")
    options = Options(terms=("coulomb", "load"), smoothing_rad_s=0.02, stribeck_rad_s=(0.1, 0.3))
    networks = {limb: network_of(settings, "MOB-fric", limb) for limb in limbs}
    found = fit(layout, settings.observer, options, networks, {limb: [pair] for limb in limbs})
    joints = found["joints"]
    assert found["smoothing_rad_s"] == 0.02
    assert list(joints) == [joint for joint in layout.actuated if joint in layout.limb("LA") + layout.limb("LL")]
    loaded = {joint for joint, row in joints.items() if row["load_per_nm"] > 0}
    assert loaded
    assert loaded <= set(layout.limb("LL"))
