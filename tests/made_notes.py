"""The note of a made-up training, as `run.json` holds it."""

from collections.abc import Sequence
from typing import Any

FIT = {"coverage": [[0.5, 0.4]], "nll": [1.0, 1.5], "crps": [0.2, 0.3]}
CALIBRATION = {
    "joints": ["LL1", "LL2"], "shares": [0.5], "scale": [0.9, 1.1], "likelihood_scale": [1.0, 1.2],
    "before": FIT, "after": FIT,
}  # fmt: skip


def training_note(name: str, losses: Sequence[float], **changes: Any) -> dict[str, Any]:
    """Return the note of a training of three words in its name, such as GRU-LL-s0, with the validation losses given."""
    method, limb, seed = name.rsplit("-", 2)
    best = {"epoch": losses.index(min(losses)) + 1, "validation_loss": min(losses)} if losses else None
    settings = {"epochs": max(1, len(losses)), "network": {"cell": "GRU", "Q": ["LL", "RL"]}}
    note = {
        "name": name, "method": method, "limb": limb, "seed": int(seed[1:]), "target": "uncertainty",
        "settings": settings | changes.pop("settings", {}), "parameters": 83712, "samples": 1800000,
        "diverged": False, "chosen_by": "validation_loss", "best": best,
        "on_windows": {"loss": -1.0, "rmse": 7.0}, "calibration": CALIBRATION, "device": "cpu", "precision": "float32",
        "fingerprint": "<script>alert(1)</script>", "provenance": {"commit": "c"},
    }  # fmt: skip
    return note | changes


def network_note(limb: str, joints: Sequence[str], inputs: Sequence[str], network: Any, std_min: float = 1e-6) -> Any:
    """Return the note that weights have; a limb's name beside those of its joints and inputs, and the cell's sizes."""
    names = {"limb": limb, "joints": list(joints), "inputs": list(inputs)}
    return {"name": "MOB-Net-LL-s0", **names, "std_min": std_min, "network": network}
