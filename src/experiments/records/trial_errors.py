"""Trials of methods on the development walks, as the table of trials has them."""

from dataclasses import dataclass, fields


@dataclass(frozen=True)
class TrialError:
    """The error of a variant of a method on the development walks of a task: a row of a table of trials.

    `tried` says what is changed, `recipe` how the network learns, `steps` from how many time steps, `seconds` in which
    processor time [s], `state` whether that diverged. `joint` is a joint of the limb, or `avg`; `rmse_nm` is the mean
    over so many walks [N m], `std_nm` their standard deviation. `best` marks the variant of its method with the
    smallest mean error.
    """

    task: str
    method: str
    tried: str
    recipe: str
    network_seed: int
    steps: int | None
    seconds: float | None
    state: str
    validation_loss: float | None
    joint: str
    rmse_nm: float
    std_nm: float | None
    walks: int
    best: int


TRIALS = tuple(field.name for field in fields(TrialError))
