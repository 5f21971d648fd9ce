"""Values on one line of YAML are read back as they were."""

import math

import pytest
import yaml
from hypothesis import given
from hypothesis import strategies as st

from mobnet.formats.reading import read_yaml
from mobnet.robot.table_file import flow

TEXTS = [
    "a, b", "a: b", "{b", "[", "#", "a #b", "- a", "yes", "No", "null", "12", "1e5", "inf", "", " a", "a ", "a\nb", '"',
    "'", "&a", "*a", "!!python/object:os.system", "%", "@", "`", "ü", "\U0001f600", "\x00", "\x1b[2J", "|", ">", "~",
    "a:",
]  # fmt: skip


@pytest.mark.parametrize("value", [math.inf, -math.inf, 1e-05, 1e300, 1.0, -2.5e-310, 3, True, False])
def test_numbers(value):
    found = yaml.safe_load(flow(value))
    assert (found, type(found)) == (value, type(value))


def test_what_is_no_number():
    assert math.isnan(yaml.safe_load(flow(math.nan)))


@pytest.mark.parametrize("text", TEXTS)
def test_names_stand_in_lists_and_as_keys(text):
    assert yaml.safe_load(flow({"names": [text, "J1"], text: text})) == {"names": [text, "J1"], text: text}
    assert "\n" not in flow([text])


@given(st.text(st.characters(exclude_categories=["Cs"])))
def test_any_text(text):
    assert yaml.safe_load(f"key: {flow([text])}") == {"key": [text]}


def test_names_as_most_robots_have_them_are_not_quoted():
    names = ["J1", "L_HipYaw_Joint", "panda/joint.1", "two-link arm", "N"]
    assert flow(names) == "[J1, L_HipYaw_Joint, panda/joint.1, two-link arm, N]"


def test_the_reader_of_the_configuration_takes_them(tmp_path):
    (tmp_path / "names.yaml").write_text("".join(f"key{k}: {flow([text])}\n" for k, text in enumerate(TEXTS)))
    assert list(read_yaml(tmp_path / "names.yaml").values()) == [[text] for text in TEXTS]
