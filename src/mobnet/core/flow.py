"""Values as YAML on one line, so that rows of a file stand below each other."""

import json
import math
import re
from collections.abc import Mapping
from typing import Any

PLAIN = re.compile(r"[A-Za-z_]([A-Za-z0-9_./ -]*[A-Za-z0-9_./-])?")  # texts that need no quotes, but for these words
OTHERWISE = re.compile(r"yes|no|on|off|true|false|null|nan|inf(inity)?", re.IGNORECASE)


def flow(value: Any) -> str:
    """Return a value as YAML on one line; numbers keep all their digits, and texts are quoted where YAML needs it."""
    if isinstance(value, Mapping):
        return "{" + ", ".join(f"{flow(key)}: {flow(own)}" for key, own in value.items()) + "}"
    if isinstance(value, (list, tuple)):
        return "[" + ", ".join(map(flow, value)) + "]"
    if isinstance(value, float):
        return _number(value)
    if isinstance(value, str) and PLAIN.fullmatch(value) and not OTHERWISE.fullmatch(value):
        return value
    quoted = json.dumps(value, ensure_ascii=False)
    return re.sub(r"[^\x20-\x7e]", lambda sign: f"\\U{ord(sign[0]):08x}", quoted)  # YAML has no pairs of surrogates


def _number(value: float) -> str:
    """Return a number as YAML takes it: 1e-05 would be a text, and infinity and NaN begin with a dot."""
    if not math.isfinite(value):
        return ".nan" if math.isnan(value) else f"{'-' if value < 0 else ''}.inf"
    digits, e, power = repr(value).partition("e")
    return f"{digits}{'' if '.' in digits else '.0'}{e}{power}"
