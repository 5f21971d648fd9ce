"""Where a job finds its files: its rule names them as `input`, and its script hands them to a function."""

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import fields, is_dataclass, replace
from pathlib import Path
from typing import Any, cast

from experiments.plan.files import ARRAY, files_in
from mobnet.core.files import WEIGHTS


def shards(folder: str, seeds: Iterable[int]) -> list[Path]:
    """Return the recordings of a set, or their residuals, by their seeds and without their endings."""
    return [Path(folder) / f"s{seed}" for seed in seeds]


def all_shards(folders: Sequence[str], seeds: Sequence[Iterable[int]]) -> list[Path]:
    """Return the recordings of several sets, set by set; `seeds` has those of each of them."""
    paths: list[Path] = []
    for folder, seeds_of_set in zip(folders, seeds, strict=True):
        paths += shards(folder, seeds_of_set)
    return paths


def stems(files: Iterable[str]) -> list[Path]:
    """Return files without their endings."""
    return [Path(file).with_suffix("") for file in files]


def only(files: Sequence[str]) -> Path | None:
    """Return the file of an input that has one or none."""
    return Path(files[0]) if files else None


def placed(named: Any, files: Iterable[str]) -> Any:
    """Return what a function gets with the job's own files in place of their names.

    The plan names a file below the folder of the project, as `results/default/plant/fits/MOB-fric.json`; the job may
    have it elsewhere, where a storage of Snakemake keeps it. Names stand at any depth of containers and dataclasses.

    Args:
        named: arguments.
        files: the job's; a name that belongs to none of them stays as it is.
    """
    if isinstance(named, Path):
        return place_of(named, files)
    if isinstance(named, dict):
        items = cast("Mapping[Any, Any]", named)
        return {key: placed(value, files) for key, value in items.items()}
    if isinstance(named, list):
        return [placed(value, files) for value in cast("list[Any]", named)]
    if type(named) is tuple:
        return tuple(placed(value, files) for value in cast("tuple[Any, ...]", named))
    if is_dataclass(named) and not isinstance(named, type) and next(files_in(named), None):
        return replace(named, **{field.name: placed(getattr(named, field.name), files) for field in fields(named)})
    return named


def place_of(name: Path, files: Iterable[str]) -> Path:
    """Return where a job has a file, an array without its ending, a file of a set, or the folder of these.

    The end of a longer path may be the same name: `results/default/captions/tables` is not the folder `tables`. The
    shortest of them belongs to the folder of the project.
    """
    known = list(files)
    for part in (name, Path(f"{name}{ARRAY}"), name / WEIGHTS, *name.parents[:-1]):
        file = _shortest(known, part)
        if file:
            return Path(file.removesuffix(str(part)) + str(name))
    folders = {str(Path(file).parent) for file in known}
    return Path(_shortest(folders, name) or name)


def _shortest(paths: Iterable[str], end: Path) -> str | None:
    """Return the shortest of the paths that are a name or end with it."""
    ending = [path for path in paths if path == str(end) or path.endswith(f"/{end}")]
    return min(ending, key=len, default=None)
