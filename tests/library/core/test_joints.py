"""The layout of the generalized velocity is that of Figure 4, and unknown names are refused."""

from itertools import chain

import numpy as np
import pytest

from mobnet.core.errors import ConfigError
from mobnet.core.joints import JointLayout


def test_tocabi_has_39_degrees_of_freedom_of_which_three_are_linear(layout: JointLayout) -> None:
    assert (layout.nv, layout.nu, layout.nq) == (39, 33, 40)
    assert [layout.unit(name) for name in layout.names] == ["N"] * 3 + ["N m"] * 36


def test_groups_partition_the_joints_and_columns_are_the_inverse_of_names(layout: JointLayout) -> None:
    members = [joint for group in layout.groups.values() for joint in group]
    assert sorted(members) == sorted(layout.names)
    order = np.random.default_rng(0).permutation(layout.nv)
    np.testing.assert_array_equal(layout.columns([layout.names[i] for i in order]), order)


def test_each_joint_has_the_limb_that_holds_it(layout: JointLayout) -> None:
    assert tuple(layout.limb_of) == tuple(chain.from_iterable(layout.groups.values()))
    assert all(joint in layout.limb(limb) for joint, limb in layout.limb_of.items())


def test_unknown_limb_and_joint_are_named(layout: JointLayout) -> None:
    with pytest.raises(ConfigError, match=r"limb: 'tail' is not accepted; accepted: LA, LL"):
        layout.limb("tail")
    with pytest.raises(ConfigError, match=r"joint: 'LL7' is not accepted"):
        layout.columns(["LL1", "LL7"])


def test_the_joints_above_the_legs_are_those_of_the_other_limbs(layout: JointLayout) -> None:
    assert layout.above_legs == layout.limbs(["W", "LA", "N", "RA"])
