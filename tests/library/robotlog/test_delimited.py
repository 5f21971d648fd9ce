"""Tables as people have them: each kind of text gives the numbers of the plain one, or one line."""

import gzip
import math
import os
import re

import numpy as np
import pytest

from mobnet.core.errors import DataError
from mobnet.formats.log_map import LogMap
from mobnet.robotlog.formats import column_names, read_log
from mobnet.robotlog.observe import converted_log

NAMES = ["time", "q.J1", "q.J2", "v.J1", "v.J2", "tau_motor.J1", "tau_motor.J2"]
TIME = np.arange(40) / 100
ROWS = np.stack([TIME, *(np.sin(k + TIME) for k in range(6))], axis=1)
HEADER, LINES = ",".join(NAMES), [",".join(f"{value:.7g}" for value in row) for row in ROWS]
PLAIN = [HEADER, *LINES]


def semicolons(lines):
    return [line.replace(",", ";").replace(".", ",") if k else line.replace(",", ";") for k, line in enumerate(lines)]


LABVIEW = [  # both headers of a LabVIEW Measurement
    *("LabVIEW Measurement\t", "Writer_Version\t2", "Separator\tTab", "Multi_Headings\tNo", "X_Columns\tOne"),
    *("***End_of_Header***\t", "\t", "Channels\t6\t\t\t\t\t\t", "Samples\t40\t40\t40\t40\t40\t40"),
    *("Y_Unit_Label\trad\trad\trad/s\trad/s\tN m\tN m", "X0\t0.0E+0\t0.0E+0\t0.0E+0\t0.0E+0\t0.0E+0\t0.0E+0"),
    *("Delta_X\t0.01\t0.01\t0.01\t0.01\t0.01\t0.01", "***End_of_Header***\t\t\t\t\t\t\t"),
]
KINDS = {
    "plain": "\n".join(PLAIN),
    "comments": "\n".join(["# two-link arm", "% by hand", "// 2024", "", *PLAIN]),
    "a title": "\n".join(["Two-link arm, log of 3 May", *PLAIN]),
    "a header that is a comment": "\n".join(["# two-link arm", f"# {HEADER}", *LINES]),
    "a header whose first name begins with a sign": "\n".join([f"%{HEADER}", *LINES]),
    "LabVIEW": "\n".join(
        [*LABVIEW, f"{HEADER},Comment".replace(",", "\t"), *(line.replace(",", "\t") for line in LINES)]
    ),
    "LabVIEW with commas": "\n".join([*(line.replace("\t", ",") for line in LABVIEW), f"{HEADER},Comment", *LINES]),
    "units below the header": "\n".join([HEADER, "s,rad,rad,rad/s,rad/s,N m,N m", *LINES]),
    "Excel of Germany": "\r\n".join(["sep=;", *semicolons(PLAIN)]),
    "tabulators and decimal commas": "\n".join(semicolons(PLAIN)).replace(";", "\t"),
    "spaces": "\n".join(PLAIN).replace(",", " "),
    "columns of one width": "\n".join(["  ".join(f"{part:>14}" for part in line.split(",")) for line in PLAIN]),
    "separators at the end of all rows": "\n".join(f"{line}," for line in PLAIN),
    "separators at the end of rows": "\n".join([HEADER, *(f"{line}," for line in LINES)]),
    "an index of pandas": "\n".join([f",{HEADER}", *(f"{k},{line}" for k, line in enumerate(LINES))]),
    "quotes": "\n".join(",".join(f'"{part}"' for part in line.split(",")) for line in PLAIN),
    "old line ends": "\r\n".join(PLAIN) + "\r\n\r\n",
    "line ends of old Macs": "\r".join(PLAIN) + "\r",
}


@pytest.mark.parametrize("ending", [".csv", ".log.gz"])
@pytest.mark.parametrize("kind", KINDS)
def test_each_kind_of_text_gives_the_numbers_of_the_plain_one(kind, ending, tmp_path):
    path = tmp_path / f"log{ending}"
    content = KINDS[kind].encode()
    path.write_bytes(gzip.compress(content) if ending.endswith(".gz") else content)
    columns = read_log(path, NAMES)
    np.testing.assert_allclose(np.stack([columns[name].values for name in NAMES], axis=1), ROWS, atol=1e-6)
    assert {column.hint for column in columns.values()} == {""}


@pytest.mark.parametrize("encoding", ["utf-8-sig", "utf-16", "cp1252"])
def test_encodings_of_windows_are_read(encoding, tmp_path):
    (tmp_path / "log.csv").write_bytes(
        "\r\n".join([f"{HEADER},angle [°]", *(f"{line},1" for line in LINES)]).encode(encoding)
    )
    assert column_names(tmp_path / "log.csv") == [*NAMES, "angle [°]"]
    np.testing.assert_allclose(read_log(tmp_path / "log.csv")["q.J2"].values, ROWS[:, 2], atol=1e-6)


@pytest.mark.parametrize("between", [",", " ", "\t"])
def test_a_cut_last_row_is_left_out_with_a_hint(between, tmp_path):
    text = "\n".join(PLAIN)[:-30].replace(",", between)
    (tmp_path / "log.csv").write_text(text)
    columns = read_log(tmp_path / "log.csv")
    assert {len(column.values) for column in columns.values()} == {39}
    assert re.search(r"^1 row left out, with \d fields in place of 7; the last", columns["time"].hint)


def test_columns_without_a_header_have_numbers_that_a_map_may_name(arm, settings, tmp_path):
    (tmp_path / "log.csv").write_text("\n".join(LINES))
    with pytest.raises(DataError, match=r'has no header; its first row is .0,0,0\.84.*by number, "0" to "6"$'):
        converted_log(tmp_path / "log.csv", arm.layout, None, settings.robotlog)
    numbers = {"q": ("1", "2"), "v": ("3", "4"), "tau_motor": ("5", "6")}
    meaning = LogMap.model_validate({"clock": {"column": "0"}} | {k: {"columns": own} for k, own in numbers.items()})
    sensed = converted_log(tmp_path / "log.csv", arm.layout, meaning, settings.robotlog).recording.sensed
    np.testing.assert_allclose(sensed.tau_motor, ROWS[:, 5:], atol=1e-6)


def test_names_that_are_numbers_are_a_header(tmp_path):
    (tmp_path / "log.csv").write_text("\n".join(["time,1,2,3", "0.0,1,2,3", "0.1,4,5,6"]))
    assert column_names(tmp_path / "log.csv") == ["time", "1", "2", "3"]


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "is empty; accepted: a log with two samples or more"),
        (HEADER, "has no row below its header; accepted: a log with two samples or more"),
        (f"{HEADER}\n{LINES[0]}", "clock: 1 row; accepted: two samples, rising times"),
        ("\0" * 5000, "byte 0 is zero, which no text has; accepted: text in UTF-8 or UTF-16"),
        ("a\0b,c\n1,2", "byte 1 is zero, which no text has"),
        (
            "\n".join(
                [HEADER, *(f"05/03/2024 12:00:0{k}.5{line[line.index(',') :]}" for k, line in enumerate(LINES[:9]))]
            ),
            "column 'time' holds text, '05/03/2024 12:00:00.5' in row 0; accepted: numbers, dates as 2026-05-03T12:00",
        ),
        ("mode,name\na,b\nc,d\n", "holds no column of numbers"),
        (
            "\n".join(PLAIN).replace("tau_motor", "torque"),
            "column: 'tau_motor.J1' is not accepted; accepted: q.J1, q.J2, time, torque.J1, torque.J2, v.J1, v.J2",
        ),
    ],
    ids=["empty", "header alone", "one row", "zeros", "a zero", "dates of the US", "texts", "other names"],
)
def test_what_cannot_be_read_is_one_line(text, message, arm, settings, tmp_path):
    (tmp_path / "log.csv").write_text(text)
    with pytest.raises(DataError) as error:
        converted_log(tmp_path / "log.csv", arm.layout, None, settings.robotlog)
    assert f"log.csv: {message}" in str(error.value)
    assert "\n" not in str(error.value)


def test_a_clock_of_another_usual_name_needs_no_map(arm, settings, tmp_path):
    (tmp_path / "log.csv").write_text("\n".join(PLAIN).replace("time", "Timestamp"))
    assert len(converted_log(tmp_path / "log.csv", arm.layout, None, settings.robotlog).recording.sensed) == 40


def test_cells_without_a_number_are_nan(tmp_path):
    (tmp_path / "log.csv").write_text("a,b\n1,\n2,nan\n3,inf\n4,5\n")
    values = read_log(tmp_path / "log.csv")["b"].values
    assert [math.isfinite(value) for value in values] == [False, False, False, True]


@pytest.mark.parametrize("between", [",", ", ", "\t", " "])
def test_words_for_missing_numbers_are_cells_without_a_number_and_are_counted(between, arm, settings, tmp_path):
    """As Excel, pandas, Python and Microsoft's C write them; one stands in the first row."""
    words = ["N/A", "None", "-nan(ind)", "1.#QNAN", "null", "NaN", *([""] if between.strip() else [])]
    rows = [line.split(",") for line in LINES]
    for k, word in enumerate(words):
        rows[3 * k][1] = word
    path = tmp_path / "log.txt"
    path.write_text("\n".join(between.join(row) for row in [NAMES, *rows]))
    found = converted_log(path, arm.layout, None, settings.robotlog)
    text = "each signal is taken on the rows that it has"
    assert found.hints == (f"no number in {len(words)} of 40 rows of q.J1: {text}",)
    np.testing.assert_allclose(found.recording.sensed.q[:30, 0], ROWS[1:31, 1], atol=1e-3)


def test_a_text_that_is_no_number_is_named_beside_words_for_missing_ones(tmp_path):
    (tmp_path / "log.csv").write_text("t,a\n0,N/A\n1,2\n2,off\n3,4\n")
    with pytest.raises(DataError, match=r"column 'a' holds text, 'off' in row 2; accepted: numbers"):
        read_log(tmp_path / "log.csv", ["a"])


@pytest.mark.parametrize("between", [",", " "])
def test_a_name_that_stands_twice_is_refused_where_a_map_uses_it_alone(between, tmp_path):
    """libfranka's logs repeat names of commands, and TwinCAT's the time of each channel."""
    (tmp_path / "log.csv").write_text("t,a,q_d,q_d,b\n0,1,2,3,4\n1,2,3,4,5\n".replace(",", between))
    assert column_names(tmp_path / "log.csv") == ["t", "a", "q_d", "b"]
    columns = read_log(tmp_path / "log.csv", ["b", "t", "a"])
    assert [[*columns[name].values] for name in "bta"] == [[4, 5], [0, 1], [1, 2]]
    with pytest.raises(
        DataError, match=r"column 'q_d' stands twice in the header; accepted: one column of that name; give"
    ):
        read_log(tmp_path / "log.csv", ["a", "q_d"])


def test_a_header_that_is_a_comment_has_its_first_name_with_and_without_the_sign(arm, settings, tmp_path):
    """`rostopic echo -p` writes %time [ns]."""
    lines = [f"{round(1e9 * t)}{line[line.index(',') :]}" for t, line in zip(TIME, LINES, strict=True)]
    (tmp_path / "log.csv").write_text("\n".join([f"%{HEADER}", *lines]))
    assert column_names(tmp_path / "log.csv") == [*NAMES, "%time"]
    (tmp_path / "spaces.txt").write_text("# t a\n0 1\n1 2\n")
    assert column_names(tmp_path / "spaces.txt") == ["t", "a"]
    signals = {key: {"columns": [f"{key}.J1", f"{key}.J2"]} for key in ("q", "v", "tau_motor")}
    for name in ("%time", "time"):
        meaning = LogMap.model_validate({"clock": {"column": name, "unit": "ns"}, **signals})
        assert converted_log(tmp_path / "log.csv", arm.layout, meaning, settings.robotlog).recording.rate_hz == 100.0


def test_what_only_ends_as_a_packed_text_is_one_line(tmp_path):
    (tmp_path / "log.csv.gz").write_text("\n".join(PLAIN))
    with pytest.raises(DataError, match=r"log\.csv\.gz: cannot be read as \.csv\.gz: Not a gzipped file"):
        column_names(tmp_path / "log.csv.gz")
    (tmp_path / "log.gz").write_bytes(gzip.compress(b"t,a\n0,1\n1,2\n"))
    with pytest.raises(DataError, match="does not say which format is packed; accepted: a text packed as"):
        column_names(tmp_path / "log.gz")


@pytest.mark.parametrize("between", [",", " "])
def test_a_name_of_a_file_that_is_not_utf8_is_read(between, tmp_path):
    path = tmp_path / os.fsdecode(b"l\xf6g.csv")
    path.write_text("\n".join(PLAIN).replace(",", between))
    np.testing.assert_allclose(read_log(path)["q.J2"].values, ROWS[:, 2], atol=1e-6)
