"""What is held for compiled code is what it would get as an argument."""

import gc

import numpy as np

from mobnet.core.compilation import compiled
from mobnet.core.machine_code import hold

RECORD = np.dtype([("count", "i8"), ("sums", "f8", 2)])


@compiled(allocating=True)
def tick(held, scale):
    """Change what is held, and return what was found in it."""
    array, record, rng, (other, factor) = held.value
    array[0] += scale * factor
    record.count += 1
    record.sums[1] += array[0]
    other[:] = array
    return rng.random()


def parts():
    """Return some of all that the plant's loop gets.

    It is a plain tuple: a type of this module would stand in the cache of `hold`, which programs without tests read.
    """
    record = np.zeros(1, RECORD).view(np.recarray)[0]
    return (np.ones(3), record, np.random.default_rng(5), (np.zeros(3), 0.5))


def test_compiled_code_changes_what_is_held_and_sees_what_others_change():
    mine = parts()
    array, record, _, (other, _) = mine
    held = hold(mine)
    assert held.of is mine
    drawn = [tick(held, 2.0)]
    np.testing.assert_array_equal(array, [2.0, 1.0, 1.0])
    array[2] = 7.0
    drawn.append(tick(held, 2.0))
    np.testing.assert_array_equal(other, [3.0, 1.0, 7.0])
    assert (record.count, *record.sums) == (2, 0.0, 5.0)
    assert drawn == [*np.random.default_rng(5).random(2)]


def test_what_is_held_lives_as_long_as_it_is_held():
    """A record is a mere address to compiled code: another one in its place would be written to."""
    held = hold(parts())
    gc.collect()
    others = [parts() for _ in range(100)]
    for _ in range(10):
        tick(held, 2.0)
    array, record, *_ = held.of
    assert (record.count, array[0]) == (10, 11.0)
    assert not any(other[1].count for other in others)
