"""Arguments of compiled code that are taken apart once, and not at each call.

At each call from Python numba takes tuples, records and generators of random numbers apart, field by field, which takes
longer than many a function that gets them. What `hold` returns is one pointer to fields that were taken apart before.
"""

from typing import Any

from numba import types
from numba.experimental import structref

from mobnet.core.compilation import compiled


@structref.register
class HeldType(types.StructRef):
    """The type of a `Held` in compiled code: it has the type of its value."""


class Held(structref.StructRefProxy):
    """A value that compiled code finds as `value`; what it refers to may change, but not which objects those are.

    Attributes:
        of: the value in Python. A record in it is a mere address to compiled code, so that it has to live as long.
    """

    of: Any


structref.define_proxy(Held, HeldType, ["value"])


def hold(value: Any) -> Held:
    """Return a value held for compiled code, such as a named tuple of arrays, records and other tuples.

    Only functions that are compiled as `allocating` take it, because it counts references.
    """
    held = _hold(value)
    held.of = value
    return held


@compiled(allocating=True)
def _hold(value: Any) -> Any:
    """Return a value held for compiled code."""
    return Held(value)
