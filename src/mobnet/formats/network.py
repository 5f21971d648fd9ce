"""A network as its files have it: the cell, and the limbs that it is for (Table 1, section 6.1)."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import AfterValidator, Field, model_validator

from mobnet.formats import base
from mobnet.formats.base import Section

CellKind = Literal["GRU", "LSTM", "RNN", "TCN", "MLP", "constant"]
Units = Annotated[base.Count, Field(le=8192)]
Steps = Annotated[base.Count, Field(le=10_000)]
Inertial = Literal["rotation", "angular_velocity", "acceleration"]
INERTIAL: tuple[Inertial, ...] = ("rotation", "angular_velocity", "acceleration")  # all that U^V has
SIZES: dict[CellKind, tuple[str, ...]] = {  # what a kind of cell needs to be told
    "GRU": ("hidden",),
    "LSTM": ("hidden",),
    "RNN": ("hidden",),
    "MLP": ("hidden", "window_steps"),
    "TCN": ("hidden", "window_steps", "kernel_steps", "dilations", "dropout", "head"),
    "constant": (),
}


class NetworkCell(Section):
    """A network's cell and its sizes, Table 1 and section 6.1.

    `hidden` is the size of the state, the channels of a TCN, or the units of an MLP; a TCN and an MLP see
    `window_steps` samples; `head` units stand between a TCN's flattened window and its output. `spectral`, as in the
    authors' code, divides weights by their spectral norm, and `input_gain` multiplies the z-scored inputs.
    """

    cell: CellKind
    hidden: Units | None = None
    window_steps: Steps | None = None
    kernel_steps: Annotated[base.Count, Field(ge=2, le=100)] | None = None
    dilations: base.Rising[Annotated[base.Count, Field(le=1000)]] | None = None
    dropout: Annotated[base.Share, Field(lt=1)] | None = None
    head: Units | None = None
    spectral: base.Flag = False
    input_gain: base.Real = Field(default=1.0, gt=0, le=1000)

    @model_validator(mode="after")
    def _has_its_sizes(self) -> NetworkCell:
        """Check that exactly the sizes are there which this kind of cell takes, and that they fit each other."""
        wanted = SIZES[self.cell]
        given = [name for name in dict.fromkeys(sum(SIZES.values(), ())) if getattr(self, name) is not None]
        if set(given) != set(wanted):
            text = f"sizes {', '.join(given) or 'none'} are not accepted"
            raise ValueError(f"{text}; accepted: {', '.join(wanted) or 'none'} of a cell {self.cell}")
        if self.spectral and self.cell != "GRU":
            raise ValueError(f"spectral: true is not accepted for a cell {self.cell}; accepted: a cell GRU")
        if self.input_gain != 1.0 and not self.spectral:
            raise ValueError(f"input_gain: {self.input_gain} is not accepted without `spectral`; accepted: 1.0")
        for dilation in self.dilations or ():
            if (self.window_steps or 0) <= ((self.kernel_steps or 0) - 1) * dilation:
                text = (
                    f"dilations: {dilation} is not accepted; accepted: (kernel_steps - 1) times it below window_steps"
                )
                raise ValueError(f"{text}, {self.window_steps}")
        return self


class Limb(Section):
    """Limbs whose torques a network predicts, and whose motion (`Q`) and desired torques (`T`) it sees.

    `imu` names the readings of the base's inertial sensor that it sees, U^V of eq. (17) where that is all of them. A
    robot whose base is fixed has none.
    """

    joints: base.Distinct[base.LimbName]
    Q: base.LimbNames
    T: base.LimbNames
    imu: Annotated[tuple[Inertial, ...], AfterValidator(base.distinct)] = INERTIAL
