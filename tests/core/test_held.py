"""What is held for compiled code is what it would get as an argument."""

import gc
from typing import NamedTuple

import numpy as np

from mobnet.core.compilation import compiled, hold

RECORD = np.dtype([("count", "i8"), ("sums", "f8", 2)])


class Parts(NamedTuple):
    """Some of all that the plant's loop gets."""

    array: np.ndarray
    record: np.record
    rng: np.random.Generator
    nested: tuple[np.ndarray, float]


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
    record = np.zeros(1, RECORD).view(np.recarray)[0]
    return Parts(np.ones(3), record, np.random.default_rng(5), (np.zeros(3), 0.5))


def test_compiled_code_changes_what_is_held_and_sees_what_others_change():
    mine = parts()
    held = hold(mine)
    assert held.of is mine
    drawn = [tick(held, 2.0)]
    np.testing.assert_array_equal(mine.array, [2.0, 1.0, 1.0])
    mine.array[2] = 7.0
    drawn.append(tick(held, 2.0))
    np.testing.assert_array_equal(mine.nested[0], [3.0, 1.0, 7.0])
    assert (mine.record.count, *mine.record.sums) == (2, 0.0, 5.0)
    assert drawn == [*np.random.default_rng(5).random(2)]


def test_what_is_held_lives_as_long_as_it_is_held():
    """A record is a mere address to compiled code: another one in its place would be written to."""
    held = hold(parts())
    gc.collect()
    others = [parts() for _ in range(100)]
    for _ in range(10):
        tick(held, 2.0)
    assert (held.of.record.count, held.of.array[0]) == (10, 11.0)
    assert not any(other.record.count for other in others)
