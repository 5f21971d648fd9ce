"""Falls of robots that random torque shakes, as their files have them."""

from dataclasses import dataclass, fields


@dataclass(frozen=True)
class Falls:
    """How often a robot fell with a largest random torque on legs and waist [N m] in so much walking [s]."""

    robot: str
    amplitude_nm: float
    walked_s: float
    falls: int


FALLS = tuple(field.name for field in fields(Falls))
