"""One recording in every format gives one residual."""

import numpy as np
import pytest

from mobnet.core.errors import DataError
from mobnet.robotlog.formats import read_log
from mobnet.robotlog.observe import observe_log
from mobnet.settings.robotlog import LogMap

ROWS = 1500
MAP = LogMap.model_validate({name: {"columns": (f"{name}.J1", f"{name}.J2")} for name in ("q", "v", "tau_motor")})


def test_csv_and_parquet_give_the_same_residual(clean, arm, settings, tmp_path):
    paths = tmp_path / "log.csv", tmp_path / "log.parquet"
    clean[:ROWS].to_csv(paths[0], index=False)
    clean[:ROWS].to_parquet(paths[1])
    found = [observe_log(path, arm, MAP, None, 100.0, 9.81, settings.robotlog) for path in paths]
    assert not any(one.converted.interpolated for one in found)
    np.testing.assert_allclose(found[0].residual, found[1].residual, atol=1e-6)


def test_texts_are_left_out(clean, tmp_path):
    clean[:10].assign(note="x").to_csv(tmp_path / "log.csv", index=False)
    assert set(read_log(tmp_path / "log.csv")) == set(clean)


@pytest.mark.parametrize("name", ["log.csv", "log.parquet"])
def test_a_damaged_file_is_one_line(name, tmp_path):
    (tmp_path / name).write_bytes(b"\x00garbage\xff" * 20)
    with pytest.raises(DataError, match=rf"^{tmp_path}/{name}: [^\n]+; accepted: [^\n]+$"):
        read_log(tmp_path / name)


def test_an_unknown_format_and_a_missing_file_name_what_is_accepted(tmp_path):
    (tmp_path / "log.mat").write_text("")
    with pytest.raises(DataError, match=r"format: '\.mat' is not accepted; accepted: \.csv, \.parquet"):
        read_log(tmp_path / "log.mat")
    with pytest.raises(DataError, match=r"none\.csv: file is missing; accepted: a log, \.csv, \.parquet"):
        read_log(tmp_path / "none.csv")
