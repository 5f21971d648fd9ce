"""From the YAML files of `configs/` to `Settings`; the only module that knows YAML.

Reading and checking run in the workflow's own process: a job receives values, so a check's code is part of no result.
"""

from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path
from typing import Any, TypeVar, cast, get_args

import yaml
from pydantic import BaseModel, ValidationError

from mobnet.core.errors import ConfigError, not_accepted
from mobnet.settings.base import Section
from mobnet.settings.checks import inconsistencies, refused_changes, unknown_names
from mobnet.settings.settings import Settings

ROOT = Path(__file__).parents[3]
CONFIGS = ROOT / "configs"
PARTS = ("config", "plant", "walking", "data", "networks", "methods", "tests", "evaluation", "scales")
NAMED_FILES = ("robot", "published", "claims")  # sections that stand in files which config.yaml names
Kind = TypeVar("Kind", bound=Section)
Place = tuple[str | int, ...]


def load_settings(folder: Path = CONFIGS, overrides: Mapping[str, Any] | None = None) -> Settings:
    """Read and check the configuration of a folder; overrides, those of `snakemake --config`, replace its values.

    Raises:
        ConfigError: a file, a key or a value is not accepted; one line for each of them.
    """
    read: dict[str, Any] = {}
    files: dict[str, Path] = {}
    for path in (folder / f"{part}.yaml" for part in PARTS):
        for section, value in read_yaml(path).items():
            if section in read:
                raise ConfigError(f"{path}: {section}: stands in {files[section]} already")
            read[section], files[section] = value, path
    read = _laid_over(read, overrides or {})
    for section in NAMED_FILES:
        if not isinstance(read.get(section), str):
            raise ConfigError(f"{folder / 'config.yaml'}: {section}: the path of a YAML file is expected")
        files[section] = folder.parent / read[section]
        read[section] = read_yaml(files[section])
    return _checked(read, files, folder / "config.yaml")


def load_section(path: Path, kind: type[Kind]) -> Kind:
    """Read one section from a file of its own, such as a robot's table.

    Raises:
        ConfigError: the file, a key or a value is not accepted; one line for each of them.
    """
    try:
        return kind.model_validate(read_yaml(path))
    except ValidationError as error:
        raise ConfigError(_lines((path, place, text) for place, text in problems(error, kind))) from None


def read_yaml(path: Path) -> dict[str, Any]:
    """Read a YAML mapping; a ConfigError names a file that is missing or holds something else."""
    try:
        value = yaml.load(path.read_text(encoding="utf-8"), yaml.CSafeLoader)
    except FileNotFoundError:
        raise ConfigError(f"{path}: file is missing") from None
    except yaml.YAMLError as error:
        raise ConfigError(f"{path}: not YAML, {' '.join(str(error).split())}") from None
    if not isinstance(value, dict):
        raise ConfigError(f"{path}: a mapping is expected, found {type(value).__name__}")
    return cast("dict[str, Any]", value)


def problems(error: ValidationError, kind: type[BaseModel]) -> Iterator[tuple[Place, str]]:
    """Yield place and text of everything that pydantic found, with what is accepted instead."""
    for found in error.errors(include_url=False):
        place, what = tuple(found["loc"]), found["type"]
        if what == "extra_forbidden":
            yield place[:-1] or place, not_accepted("key", place[-1], _keys_at(kind, place[:-1]))
        elif what == "missing":
            yield place, "key is missing"
        elif what == "value_error":
            yield place, str(found.get("ctx", {}).get("error"))
        else:
            yield place, f"{found['input']!r} is not accepted; {found['msg'][:1].lower()}{found['msg'][1:]}"


def _checked(read: Mapping[str, Any], files: Mapping[str, Path], main: Path) -> Settings:
    """Return the configuration if every value, name and change in it is accepted."""
    try:
        settings = Settings.model_validate(read)
    except ValidationError as error:
        found = problems(error, Settings)
        raise ConfigError(_lines((files.get(str(place[0]), main), place, text) for place, text in found)) from None
    wrong = list(unknown_names(settings))
    if not wrong:  # only then can what they name be looked up
        for place, section, error in refused_changes(settings):
            wrong += [((*place, *map(str, inner)), text) for inner, text in problems(error, section)]
        wrong += inconsistencies(settings)
    if wrong:
        raise ConfigError(_lines((files[place[0]], place, text) for place, text in dict.fromkeys(wrong)))
    return settings


def _laid_over(values: Mapping[str, Any], overrides: Mapping[str, Any]) -> dict[str, Any]:
    """Return values with overrides in their place, mappings merged key by key."""
    merged = dict(values)
    for key, value in overrides.items():
        below = merged.get(key)
        if isinstance(below, dict) and isinstance(value, dict):
            merged[key] = _laid_over(cast("dict[str, Any]", below), cast("dict[str, Any]", value))
        else:
            merged[key] = value
    return merged


def _keys_at(kind: Any, place: Place) -> list[str]:
    """Return the keys that the section at a place accepts."""
    sections = [kind]
    for key in place:
        below = [section.model_fields[str(key)].annotation for section in sections if str(key) in section.model_fields]
        sections = list(_sections(below)) or sections  # a place also holds numbers and the tags of unions
    return [name for section in sections for name in section.model_fields]


def _sections(kinds: Iterable[Any]) -> Iterator[type[BaseModel]]:
    """Yield the sections that annotations name, at any depth."""
    for kind in kinds:
        if isinstance(kind, type) and issubclass(kind, BaseModel):
            yield kind
        else:
            yield from _sections(get_args(kind))


def _lines(found: Iterable[tuple[Path, Place, str]]) -> str:
    """Return one line for each problem: file, keys joined by dots, text."""
    return "\n".join(f"{path}: {'.'.join(map(str, place)) or 'top level'}: {text}" for path, place, text in found)
