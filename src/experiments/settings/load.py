"""From the YAML files of `configs/` to `Settings`; every fault is one line with file, line, key, value and accepted.

Reading and checking run in the workflow's own process: a job receives values, so a check's code is part of no result.
"""

from collections.abc import Callable, Iterable, Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, cast

from experiments.settings.catalogue import Catalogue
from experiments.settings.checks.sections import inconsistencies, refused_changes, unknown_names
from experiments.settings.claims import spelt_out, where_typed
from experiments.settings.settings import Settings
from mobnet.core.errors import ConfigError
from mobnet.core.files import files_like
from mobnet.formats.checks.robot import robot_problems
from mobnet.formats.faults import problems, refuse_faults, validated
from mobnet.formats.reading import Document, Place, Problem, dotted, read_override
from mobnet.settings.lab import CONFIGS

ROOT = Path(__file__).parents[3]
PARTS: Mapping[str, tuple[str, ...]] = {  # file -> the sections that stand in it
    "config": ("scale", "keep", "seed", "robot", "published", "claims"),
    "plant": ("rates", "plant", "levels"),
    "surrogate": ("surrogate", "fleet"),
    "walking": ("walking",),
    "data": (
        "terrain",
        "commands",
        "random_torque",
        "motions",
        "pushes",
        "obstacles",
        "scenarios",
        "training_sets",
        "recording",
    ),
    "networks": ("networks", "learning", "stacks"),
    "methods": ("observer", "methods", "sweeps"),
    "trials": ("development", "trials"),
    "detection": ("detection", "contact_point"),
    "reaction": ("reaction",),
    "robotlog": ("robotlog",),
    "motion": ("free_motion",),
    "evaluation": ("evaluation",),
    "scales": ("scales",),
}
NAMED_FILES = ("robot", "published", "claims")  # sections that stand in files which config.yaml names
WITH_NULLS = ("published", "claims")  # null: the paper prints no number; a range has no bound
Check = Callable[[Settings], Iterable[Problem]]


@dataclass(frozen=True)
class Sources:
    """Where values come from: the file of each section, and overrides, whose values replace those of files.

    A section that is missing has the file in which it should stand.
    """

    main: Document
    files: Mapping[str, Document]
    overrides: Mapping[str, Any]

    def told(self, place: Place, text: str) -> str:
        """Return one line about a place."""
        if place and self._overridden(place):
            return f"--config: {dotted(place)}: {text}"
        section = str(place[0]) if place else ""
        document = self.files.get(section, self.main)
        if section == "claims":
            place = where_typed(place, document.values)
        is_own = section in NAMED_FILES and document is not self.main
        return document.told(place[1:] if is_own else place, text)

    def _overridden(self, place: Place) -> bool:
        """Return whether what stands at a place is an override, or belongs to one."""
        value: Any = self.overrides
        for index, key in enumerate(place):
            if not isinstance(value, Mapping):
                return True
            if key not in value:
                return self._is_new(place[:index])
            value = cast("Mapping[Any, Any]", value)[key]
        return True

    def _is_new(self, place: Place) -> bool:
        """Return whether no file holds what stands at a place."""
        document = self.files.get(str(place[0])) if place else self.main
        return document is None or not document.holds(place)


def load_settings(
    folder: Path = CONFIGS, overrides: Mapping[str, Any] | None = None, further: Check | None = None
) -> Settings:
    """Read and check the configuration of a folder; overrides, those of `snakemake --config`, replace its values.

    What other packages know, such as the options of a method's kind, is checked by `further`.

    Raises:
        ConfigError: a file, a key or a value is not accepted; one line for each of them.
    """
    documents, files, faults = _read(folder)
    odd: list[Problem] = []
    overridden = cast("dict[str, Any]", read_override(overrides or {}, (), odd))
    values = _laid_over({key: files[key].values[key] for key in files}, overridden)
    homes: dict[str, Document] = {}
    for document in documents:
        homes |= dict.fromkeys(PARTS[document.path.stem], document)
    sources = Sources(documents[0], {**homes, **files}, overridden)
    for section in NAMED_FILES:
        path = folder.parent / values[section] if isinstance(values.get(section), str) else None
        if path is None or not path.is_file():
            near = files_like(path) if path else ""
            text = f"{values.get(section)!r} is not accepted; accepted: the path of a YAML file{near}"
            odd.append(((section,), text))
        else:
            files[section] = Document(path, nulls=section in WITH_NULLS)
            documents.append(files[section])
            values[section] = files[section].values
    faults += _faults_of(documents)
    faults += [sources.told(place, text) for place, text in odd]
    refuse_faults(faults)
    # the sections of those files now stand in them, and an override of their paths is none of their values
    inner = {key: value for key, value in overridden.items() if key not in NAMED_FILES}
    return _checked(values, Sources(documents[0], {**homes, **files}, inner), further)


def _read(folder: Path) -> tuple[list[Document], dict[str, Document], list[str]]:
    """Return the files of a folder, the file of each section, and what stands in two of them."""
    if not folder.is_dir():
        raise ConfigError(f"{folder / 'config.yaml'}: file is missing; accepted: a folder with {', '.join(PARTS)}.yaml")
    documents = [Document(folder / f"{part}.yaml") for part in PARTS]
    files = dict[str, Document]()
    faults = list[str]()
    for document in documents:
        for section in document.values:
            if section in files:
                text = f"stands in {files[section].path} too, which is not accepted; accepted: each section once"
                faults.append(document.told((section,), text))
            files[section] = document
    if not all(document.is_readable for document in documents):  # only then are all sections there
        refuse_faults(_faults_of(documents))
    return documents, files, faults


def _faults_of(documents: Iterable[Document]) -> list[str]:
    """Return what is not accepted of some files by themselves."""
    lines: list[str] = []
    for document in documents:
        lines += document.faults
    return lines


def _checked(values: Mapping[str, Any], sources: Sources, further: Check | None) -> Settings:
    """Return the configuration if every value, name and change in it is accepted."""
    typed = {**values, "claims": spelt_out(values.get("claims"))}
    settings = validated(Settings, values, typed, sources.told)
    catalogue = Catalogue(settings)
    wrong: list[Problem] = [(("robot", *place), text) for place, text in robot_problems(settings.robot)]
    wrong += unknown_names(catalogue)
    if not wrong:  # only then can what they name be looked up
        wrong = list(_changes(catalogue))
    if not wrong:
        wrong = [*inconsistencies(catalogue), *(further(settings) if further else ())]
    refuse_faults(sources.told(place, text) for place, text in wrong)
    return settings.with_own_sweeps()


def _changes(catalogue: Catalogue) -> Iterator[Problem]:
    """Yield what methods change of other sections and may not."""
    for place, section, given, error in refused_changes(catalogue):
        for inner, text in problems(error, section, given):
            yield place if place[0] == "sweeps" else (*place, *inner), text  # there the key is the sweep's own name


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
