"""Parameters are exactly the section of the configuration; the state starts at zero."""

import numba
import numpy as np
from pydantic import create_model

from mobnet.control.parameters import STATE, empty_state, walking_parameters


def test_parameters_are_the_section(settings, par):
    assert par.dtype.names == tuple(type(settings.walking).model_fields)
    for name, value in settings.walking:
        np.testing.assert_array_equal(par[name], value)


def test_type_of_compiled_code_changes_with_the_fields_and_their_order(settings):
    """Cached machine code is found by it."""
    turned_round = {name: (object, value) for name, value in reversed(dict(settings.walking).items())}
    same, other = walking_parameters(settings.walking), walking_parameters(create_model("Other", **turned_round)())
    assert numba.typeof(same) == numba.typeof(walking_parameters(settings.walking))
    assert numba.typeof(same) != numba.typeof(other)


def test_state_starts_at_zero_and_states_do_not_share_memory():
    first, second = empty_state(), empty_state()
    first.t = 1.0
    assert all(not np.any(second[name]) for name in STATE.names or ())
