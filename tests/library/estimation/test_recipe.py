"""A recipe holds the files that its method needs, no more and no fewer."""

import pytest

from mobnet.core.errors import ConfigError


@pytest.mark.parametrize(("method", "limbs", "fitted", "message"), [
    ("MOB2", [], False, "method: 'MOB2' is not accepted; accepted: MOB, MOB-Net, "),
    ("MOB", ["LL"], False, r"networks of method MOB: \['LL'\] is not accepted; accepted: none"),
    ("FTS-e2e", ["LA", "LL"], False, r"\['LA', 'LL'\] is not accepted; accepted: some of \['LL'\]"),
    ("FTS-e2e", [], False, r"networks of method FTS-e2e: \[\] is not accepted; accepted: some of \['LL'\]"),
    ("MOB-fric", [], False, "'MOB-fric' with the fit None; accepted: the file that rule `fit` writes"),
    ("MOB-fric-BPF", [], False, "'MOB-fric-BPF' with the fit None"),
    ("MOB", [], True, "'MOB' with the fit .*; accepted: none"),
])  # fmt: skip
def test_files_that_do_not_fit_the_method_are_refused(method, limbs, fitted, message, recipe_of, tmp_path):
    with pytest.raises(ConfigError, match=message):
        recipe_of(method, networks=dict.fromkeys(limbs, tmp_path), fitted=tmp_path if fitted else None)


def test_a_method_may_run_some_of_its_networks(recipe_of, tmp_path):
    assert set(recipe_of("MOB-Net", networks={"LL": tmp_path}).networks) == {"LL"}


def test_a_method_of_another_takes_the_others_files(recipe_of, tmp_path):
    assert recipe_of("MOB-fric-BPF", fitted=tmp_path).method.of == "MOB-fric"


def test_without_limbs_there_are_no_networks(recipe_of):
    assert recipe_of("MOB").limb_networks() is None


def test_the_observer_knows_the_robot_as_the_level_says(recipe_of):
    for level, ratio in (("all_uncertainty", 0.9), ("ideal", 1.0)):
        assert recipe_of("MOB", level).observer().nominal.mass_ratio == ratio
