"""The rule `fit`: which methods it takes, and what it writes."""

import pytest

from experiments.jobs.fitting import write_fit
from experiments.settings.catalogue import Catalogue
from mobnet.core.errors import ConfigError
from mobnet.core.files import read_json
from mobnet.estimation.kinds.friction import read_friction


def fit(settings, method, training, folder):
    networks, out = {limb: Catalogue(settings).network(method, limb) for limb in training}, folder / f"{method}.json"
    write_fit(settings.layout, settings.observer, Catalogue(settings).method(method), networks, training, out)
    return out


def test_what_it_writes_is_what_the_kind_reads(settings, made_up, write_pair, tmp_path):
    pair, layout = write_pair(tmp_path, made_up(1, 1.0)), settings.layout
    limbs = Catalogue(settings).method("MOB-fric").fitted
    out = fit(settings, "MOB-fric", {limb: [pair] for limb in limbs}, tmp_path / "fits")
    fitted = {joint for limb in limbs for joint in layout.limb(limb)}
    assert set(read_json(out)["joints"]) == fitted
    chosen = dict(zip(layout.actuated, read_friction(out, layout.actuated).stribeck, strict=True))
    assert {joint: chosen[joint] for joint in fitted} == {
        joint: row["stribeck_rad_s"] for joint, row in read_json(out)["joints"].items()
    }


@pytest.mark.parametrize("method", ["MOB", "MOB-Net", "MOB-fric-BPF"])
def test_methods_that_are_not_fitted_are_refused(method, settings, tmp_path):
    with pytest.raises(ConfigError, match=rf"{method}.json: method of kind .* with `fitted` \[\] is not fitted"):
        fit(settings, method, {}, tmp_path)


def test_other_limbs_than_the_methods_are_refused(settings, tmp_path):
    with pytest.raises(ConfigError, match=r"MOB-fric.json: limbs to fit: \['LL'\] is not accepted; accepted: \['LA'"):
        fit(settings, "MOB-fric", {"LL": []}, tmp_path)
