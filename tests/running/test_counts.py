"""The table of jobs at the start of a run."""

import logging

from mobnet.running.counts import by_kind


def record_of(message: str, **extra: object) -> logging.LogRecord:
    record = logging.LogRecord("snakemake", logging.INFO, "", 0, message, None, None)
    vars(record).update(extra)
    return record


def test_rules_of_a_kind_are_one_row_and_others_keep_theirs() -> None:
    stats = {"collect_a": 1, "collect_b": 1, "table_05": 1, "total": 3}
    record = record_of("Job stats: ...", stats=stats)
    assert by_kind({"collect_a": "collect", "collect_b": "collect"})(record)
    assert record.getMessage().splitlines() == ["Job stats:", "collect       2", "table_05      1", "total         3"]


def test_other_messages_stay_as_they_are() -> None:
    record = record_of("1 of 3 steps (33%) done")
    assert by_kind({})(record)
    assert record.getMessage() == "1 of 3 steps (33%) done"
