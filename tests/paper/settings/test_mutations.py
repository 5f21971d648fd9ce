"""Whatever is changed in a file of the configuration is refused at its place, or is another possible value."""

import logging
import re
from collections import Counter
from pathlib import Path
from typing import Any

import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from mobnet.core.errors import ConfigError
from mobnet.formats.reading import read_yaml

from .mutations import FILES, REFUSED, VALUES, Load, Mutation, changes, dumped, places, refusal, written_twice

log = logging.getLogger(__name__)
DRAWN, DRAWN_TWICE, LEAST_SHARE = 330, 30, 0.75
NULLS = ("published", "claims")  # where null has a meaning

ALL = [
    Mutation(file, place, kind, "")
    for file in FILES
    for place, value in places(VALUES[file])
    if place
    for kind in changes(value)
]
TWICE = [mutation for file in FILES for mutation in written_twice(file)]


def is_always_refused(mutation: Mutation, value: Any) -> bool:
    """Return whether a change has no meaning wherever it is made; null is a number that the paper does not print."""
    if mutation.kind == "nothing" and mutation.file in NULLS and not isinstance(value, str):
        return False
    return mutation.kind in REFUSED


def value_at(mutation: Mutation) -> Any:
    """Return what stands at the place of a change."""
    value = VALUES[mutation.file]
    for key in mutation.place:
        value = value[key]
    return value


def test_every_mutation_is_refused_in_one_line_or_harmless(load_with: Load) -> None:
    counts: Counter[str] = Counter()

    @settings(
        max_examples=DRAWN, deadline=None, derandomize=True, suppress_health_check=[HealthCheck.function_scoped_fixture]
    )
    @given(st.sampled_from(ALL))
    def try_one(mutation: Mutation) -> None:
        value = value_at(mutation)
        lines = refusal(load_with, mutation.file, dumped(mutation.file, mutation.place, changes(value)[mutation.kind]))
        assert lines or not is_always_refused(mutation, value), mutation
        counts["refused" if lines else "accepted"] += 1

    try_one()
    log.info("%d mutations drawn: %d refused, %d accepted", counts.total(), counts["refused"], counts["accepted"])
    assert counts.total() >= 300, counts
    assert counts["refused"] >= LEAST_SHARE * counts.total(), counts


@settings(
    max_examples=DRAWN_TWICE,
    deadline=None,
    derandomize=True,
    suppress_health_check=[HealthCheck.function_scoped_fixture],
)
@given(st.sampled_from(TWICE))
def test_a_key_that_is_written_twice_is_refused(load_with: Load, mutation: Mutation) -> None:
    (line,) = refusal(load_with, mutation.file, mutation.text)
    key = re.escape(str(mutation.place[-1]))
    assert re.search(rf"a second '{key}' is not accepted; accepted: each key once, it stands in line \d+ too$", line)


@pytest.mark.parametrize(
    ("file", "old", "new", "message"),
    [
        ("config", "seed: 2023", "seed: 2023\n__use_yte__: true", "__use_yte__: key: '__use_yte__' is not accepted"),
        ("config", "seed: 2023", "seed: !!python/object/apply:os.system [exit 3]", "seed: tag 'tag:yaml.org,2002:pyth"),
        ("config", "seed: 2023", "seed: !!python/name:os.system ''", "python/name:os.system' nothing is not accepted"),
        ("config", "seed: 2023", "seed: !!int 20_23", "seed: 20_23 is not accepted; accepted: decimal digits"),
        ("config", "seed: 2023", "seed: 02023", "seed: 02023 is not accepted; accepted: decimal digits"),
        ("config", "seed: 2023", "seed: 0x7e7", "seed: 0x7e7 is not accepted; accepted: decimal digits"),
        ("config", "seed: 2023", "seed: 20:23", "seed: 20:23 is not accepted; accepted: decimal digits"),
        ("config", "seed: 2023", "seed: 2e3", "seed: 2e3 is not accepted; accepted: .*such as 1000 or 1.0e[+]3"),
        ("config", "seed: 2023", "seed: 2023-01-01", "timestamp' 2023-01-01 is not accepted; accepted: .*quotes"),
        ("config", "seed: 2023", "seed:", "seed: nothing is not accepted; accepted: a value"),
        ("config", "seed: 2023", "seed: ~", "seed: ~ is not accepted; accepted: a value"),
        ("config", "seed: 2023", "1: 2023", "key '1' is not accepted; accepted: text"),
        ("config", "seed: 2023", "[seed]: 2023", "key '.' is not accepted; accepted: text"),
        ("config", "seed: 2023", "seed: 2023\nno: 1", "key 'no' is not accepted; accepted: text"),
        ("config", "seed: 2023", "seed: &a [*a]", "seed: more than 100000 values are not accepted"),
        ("config", "seed: 2023", "seed: *b", r"not YAML, found undefined alias \*b"),
        ("config", "seed: 2023", "seed: [2023", "not YAML, did not find expected"),
        ("config", "seed: 2023", "\tseed: 2023", "not YAML, found character"),
        ("config", "seed: 2023", "---\nseed: 2023", "not YAML, but found another document"),
        ("config", "seed: 2023", "seed: \x07", "not YAML, control characters are not allowed"),
        ("config", "seed: 2023", f"seed: {'[' * 5000}", "not YAML, "),
        ("data", "random_torque: true", "random_torque: yes", "random_torque: yes is not accepted; accepted: true or"),
        ("data", "episode_s: 75.0", "episode_s: .inf", "episode_s: .inf is not accepted; accepted: a finite"),
        ("data", "episode_s: 75.0", "episode_s: 1:15.0", "episode_s: 1:15.0 is not accepted; accepted: a finite"),
        ("data", "episode_s: 75.0", "episode_s: 1.0e+999", "episode_s: 1.0e[+]999 is not accepted; accepted: a finite"),
        ("data", "episode_s: 75.0", "<<: 75.0", "recording.<<: what is merged is not accepted; accepted: one mapping"),
        ("plant", "solver_tolerance: 1.0e-6", "solver_tolerance: 1e-6", "solver_tolerance: 1e-6 is not accepted; acc"),
        ("plant", "gravity_m_s2: 9.81", "gravity_m_s2: 9,81", "gravity_m_s2: 9,81 is not accepted; accepted: a fin"),
        ("plant", "gravity_m_s2: 9.81", "gravity_m_s2: .NaN", "gravity_m_s2: .NaN is not accepted; accepted: a fin"),
    ],
)  # fmt: skip
def test_a_yaml_file_is_data_and_means_what_it_looks_like(
    load_with: Load, file: str, old: str, new: str, message: str
) -> None:
    text = FILES[file].read_text()
    assert old in text
    assert re.search(message, refusal(load_with, file, text.replace(old, new, 1))[0])


def test_aliases_that_stand_for_billions_are_refused(load_with: Load) -> None:
    bomb = "".join(f"  o{k}: &o{k} [{', '.join([f'*o{k - 1}'] * 9) if k else 1}]\n" for k in range(12))
    text = (
        FILES["methods"]
        .read_text()
        .replace("    options: &friction\n", f"    options: &friction\n{bomb.replace('  o', '      o')}")
    )
    assert "more than 100000 values are not accepted" in refusal(load_with, "methods", text)[0]


@pytest.mark.parametrize(
    ("content", "message"),
    [
        (None, "file is missing"), (b"", "a list, a text or nothing is not accepted"), (b"\xff\xfe", "is not UTF-8"),
        (b"# nothing\n", "a list, a text or nothing is not accepted"), (b"- 1\n", "accepted: a mapping of keys"),
        (b"text", "accepted: a mapping of keys"),
    ],
)  # fmt: skip
def test_a_file_that_holds_no_mapping_is_named(tmp_path: Path, content: bytes | None, message: str) -> None:
    path = tmp_path / "some.yaml"
    if content is not None:
        path.write_bytes(content)
    with pytest.raises(ConfigError, match=message):
        read_yaml(path)
    with pytest.raises(ConfigError, match="a folder is not accepted; accepted: a file"):
        read_yaml(tmp_path)
