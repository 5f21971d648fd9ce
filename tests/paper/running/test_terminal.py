"""What a run shows of its jobs, by made records and logs: plain lines, lines in place, and what is never left out."""

import json
import logging
import os
import pty
import subprocess
import sys
from types import SimpleNamespace

import pytest
from snakemake_interface_logger_plugins.common import LogEvent
from snakemake_interface_logger_plugins.registry import LoggerPluginRegistry

from experiments.running.progress import START_S, Job, RunState, in_time, in_words
from experiments.running.terminal import RunHandler, drawn

ASKED = {"dryrun": False, "verbose": False, "printshellcmds": False, "debug_dag": False, "quiet": None, "nocolor": True}
LOG = "results/smoke/logs/train/plant/MOB-Net-LL-s0.log"
NAME = "train plant, MOB-Net-LL-s0"
NOW_S = 1000.0
COMPILING = "compiling code for this processor"  # as mobnet.core.compilation says


def record(text=None, level=logging.INFO, **told):
    made = logging.LogRecord("snakemake", level, "", 0, text, (), None)
    made.__dict__.update(told)
    return made


def started(number, rule="train", log=(LOG,)):
    return record(event=LogEvent.JOB_INFO, jobid=number, rule_name=rule, log=list(log))


@pytest.fixture
def lines(capsys):
    """Return a function of a handler and records that returns the lines printed of them, without their times."""

    def show(handler, *records):
        for one in records:
            handler.emit(one)
        printed = capsys.readouterr().err.splitlines()
        return [line.partition(" ")[2] if line[2:3] == ":" else line for line in printed]

    return show


@pytest.fixture
def handler():
    return RunHandler(SimpleNamespace(**ASKED), None)


@pytest.mark.parametrize(("rule", "log", "words"), [
    ("train", LOG, NAME),
    ("table", "results/smoke/logs/table/table_05.log", "table table_05"),
    ("collect", "results/default/logs/collect/robot_1/forward_walk-ideal.log", "record robot_1, forward_walk-ideal"),
    ("manifest", "results/default/logs/manifest.log", "manifest"),
    ("runs_page", "results/default/logs/runs_page.log", "runs page"),
    ("all", None, "all"),
])  # fmt: skip
def test_a_job_is_named_in_words(rule, log, words):
    assert in_words(rule, log) == words


@pytest.mark.parametrize(("seconds", "text"), [(0.4, "0 s"), (59, "59 s"), (61, "1 min"), (3700, "1 h 02 min")])
def test_times_are_short(seconds, text):
    assert in_time(seconds) == text


@pytest.mark.parametrize(("texts", "done"), [
    ([f"{COMPILING}, which may take a minute, once"], 0.0),
    (["3 of 12 epochs, loss 0.1"], 0.25),
    (["recording 2 of 4, s101"], 0.25),
    (["recording 2 of 4, s101", "15 of 30 s simulated"], 0.375),
    (["recording 2 of 4, s101", "30 of 30 s simulated", "5 of 30 s simulated"], 0.5),  # a second stretch
    (["s101: 0 falls of 3 seen"], 0.0),
])  # fmt: skip
def test_a_log_tells_how_far_a_job_is(tmp_path, texts, done):
    job = Job("a", tmp_path / "a.log", 0.0)
    job.follow()  # before it is there
    (tmp_path / "a.log").write_text("".join(f"12:00:00 INFO {text}\n" for text in texts) + "12:00:01 INFO 9 of")
    job.follow()
    assert (job.done, job.text) == (pytest.approx(done), texts[-1])


def test_the_log_of_an_earlier_run_does_not_count(tmp_path):
    path = tmp_path / "a.log"
    path.write_text("12:00:00 INFO 9 of 10 epochs\n")
    os.utime(path, (NOW_S - 1, NOW_S - 1))
    job = Job("a", path, NOW_S)
    job.follow()
    assert job.done == 0.0


def test_time_left_follows_prices_and_the_pace_of_jobs_that_ended():
    state = RunState(total=3, slots=2)
    state.expect({1: 10.0 - START_S, 2: 20.0 - START_S, 3: 40.0 - START_S})
    assert state.left_s(NOW_S) is None  # nobody knows yet how fast this machine is
    state.begin(1, "a", None, NOW_S)
    state.end(1, NOW_S + 20.0)
    assert state.pace == pytest.approx(2.0)
    assert state.share == pytest.approx(10.0 / 70.0)
    running = state.begin(3, "c", None, NOW_S + 20.0)
    # That of the longest job, which is more than half of all.
    assert state.left_s(NOW_S + 20.0) == pytest.approx(80.0)
    running.take("3 of 4 epochs")
    assert running.left_s(NOW_S + 50.0 + START_S, None) == pytest.approx(10.0)


def test_time_left_is_not_told_before_it_is_known_and_hardly_rises():
    """A machine of two cores, three times as slow as the prices, on which the first two jobs compile for 3 minutes."""
    slow, starts_s, compiles_s = 3.0, 3.0, 180.0
    most, more_s = 1.25, 90.0  # a long job may come last
    prices = {number: (5.0, 20.0, 60.0)[number % 3] for number in range(60)}
    state = RunState(total=len(prices), slots=2)
    state.expect(prices)
    waiting = list(prices)
    ends_s, begins_s, now_s = {}, {}, NOW_S
    told, shown = [], []
    while waiting or ends_s:
        for number in [number for number, end_s in ends_s.items() if end_s <= now_s]:
            del ends_s[number]
            state.end(number, now_s)
        while waiting and len(ends_s) < state.slots:
            number = waiting.pop(0)
            job = state.begin(number, f"job {number}", None, now_s)
            begins_s[number] = now_s + starts_s + (compiles_s if number < state.slots else 0.0)
            ends_s[number] = begins_s[number] + slow * prices[number]
            job.text = "loading"
        for number, job in state.running.items():
            if now_s >= begins_s[number]:
                share = (now_s - begins_s[number]) / (ends_s[number] - begins_s[number])
                job.take(f"{100 * share:.0f} of 100 s simulated")
            elif number < state.slots:
                job.take(f"{COMPILING}: {int(now_s - NOW_S)} functions in 20 s so far")
        left_s = state.left_s(now_s)
        if left_s is not None:
            told.append(left_s)
        shown.append(drawn(state, now_s, os.terminal_size((100, 30))))
        now_s += 1.0
    assert "compiles code, once: 100 functions, 2 min" in shown[100][0]
    assert shown[100][-1].endswith("time left: not known while code compiles")
    assert len(told) > len(shown) / 2
    assert told[0] == pytest.approx(len(told), rel=0.1)
    for number, left_s in enumerate(told[1:], start=1):
        assert left_s < most * min(told[:number]) + more_s


RUNS = (
    record("Building DAG of jobs..."),
    record("Provided cores: 2", event=LogEvent.RESOURCES_INFO, cores=2),
    record("stats", event=LogEvent.RUN_INFO, stats={"train": 1, "total": 2}),
)


def test_plain_lines_tell_start_and_end(handler, lines):
    printed = lines(
        handler,
        *RUNS,
        record("Select jobs to execute..."),
        record("Execute 1 jobs...", event=LogEvent.JOB_STARTED, jobs=[4]),
        started(4),
        record("Finished jobid: 4", event=LogEvent.JOB_FINISHED, job_id=4),
        record("None", event=LogEvent.PROGRESS, done=1, total=2),
        record("Complete log(s): /home/somebody/a.log"),
    )
    assert printed == [f"begins: {NAME}", f"done: {NAME}, 0 s (1 of 2 jobs, 50 %)"]


@pytest.mark.parametrize(("waiting", "made", "said"), [
    (285, 77, "285 of 362 jobs; 77 are made already"), (1, 1, "1 of 2 jobs; 1 is made already"), (1, 0, "1 job"),
])  # fmt: skip
def test_a_run_that_goes_on_says_what_is_made(handler, capsys, waiting, made, said):
    handler.expect({}, waiting=waiting, made=made)
    assert capsys.readouterr().err.endswith(f" {said}\n")


@pytest.mark.parametrize("records", [(record("Building DAG of jobs..."),), ()])
def test_what_snakemake_says_stays_where_there_is_nothing_to_run(handler, lines, capsys, records):
    said = "Nothing to be done (all requested files are present and up to date)."
    assert lines(handler, *records, record(said)) == []
    handler.close()
    assert capsys.readouterr().err.splitlines() == [*(one.getMessage() for one in records), said]


@pytest.mark.parametrize("asked", ["dryrun", "verbose", "printshellcmds", "debug_dag", "quiet"])
def test_a_run_that_was_asked_for_details_is_left_to_snakemake(lines, asked):
    given = [SimpleNamespace(name="PROGRESS")] if asked == "quiet" else True
    handler = RunHandler(SimpleNamespace(**{**ASKED, asked: given}), None)
    assert not handler.writes_to_stream
    assert lines(handler, record("a warning", logging.WARNING)) == []


def test_a_failure_names_the_log_and_no_error_is_lost(handler, lines, capsys):
    caused = "RuleException:\nCalledProcessError in file \"a.smk\", line 3:\nCommand 'a' "
    failed = {"event": LogEvent.JOB_ERROR, "jobid": 4, "rule_name": "train", "log": [LOG], "indent": False}
    printed = lines(
        handler,
        *RUNS,
        started(4),
        record(f"{caused}returned non-zero exit status 1.", logging.ERROR, event=LogEvent.ERROR),
        record(f"{caused}returned non-zero exit status 137.", logging.ERROR, event=LogEvent.ERROR),
        record("Error in rule train", logging.ERROR, **failed),
        record("a warning of Snakemake", logging.WARNING),
    )
    assert printed[1:] == [
        *f"{caused}returned non-zero exit status 137.".splitlines(),
        f"failed: {NAME} (log: {LOG})",
        "a warning of Snakemake",
    ]
    assert handler.stop() == "0 of 2 jobs are made"
    assert lines(handler, started(5), record("", logging.ERROR, **failed)) == []


def test_jobs_that_went_into_a_queue_together_fail_once(handler, lines):
    one = {"event": LogEvent.JOB_ERROR, "jobid": 4, "rule_name": "train", "log": [LOG], "indent": True}
    together = {"event": LogEvent.GROUP_ERROR, "groupid": "a", "aux_logs": ["7.log"], "job_error_info": [one]}
    printed = lines(handler, record("", logging.ERROR, **together), record("", logging.ERROR, **one))
    assert printed == ["failed: jobs that went into the queue together (log: 7.log)"]


@pytest.mark.parametrize("width", [40, 60, 80, 200])
def test_lines_in_place_never_wrap(width):
    state = RunState(total=300, done=7, began_s=NOW_S)
    for number in range(40):
        name = f"record robot_1, a_scenario_with_a_long_name-and_level_{number}"
        state.begin(number, name, None, NOW_S).take(f"{COMPILING}: 107 functions in 158 s so far")
    shown = drawn(state, NOW_S + 4000.0, os.terminal_size((width, 14)))
    assert len(shown) == 12  # ten jobs, that there are more, and the run
    assert shown[-2] == "and 30 more"
    assert shown[-1].startswith("7 of 300 jobs, "[:15])
    assert all(len(line) < width for line in shown)


def test_snakemake_finds_it_by_the_name_in_the_profile():
    assert LoggerPluginRegistry().get_plugin("mobnet").log_handler is RunHandler


IN_PLACE = """
import json, logging, os, sys, time
from types import SimpleNamespace
from experiments.running.terminal import RunHandler
from snakemake_interface_logger_plugins.common import LogEvent

def emit(**told):
    record = logging.LogRecord("snakemake", logging.INFO, "", 0, "", (), None)
    record.__dict__.update(told)
    handler.emit(record)

handler = RunHandler(SimpleNamespace(**json.loads(sys.argv[1])), None)
emit(event=LogEvent.RUN_INFO, stats={"total": 1})
emit(event=LogEvent.JOB_INFO, jobid=4, rule_name="train", log=[sys.argv[2]])
os.system("echo a word of a job >&2")
time.sleep(1.5)
handler.close()
sys.stderr.write("the end\\n")
"""


def test_on_a_terminal_what_jobs_print_stands_above_and_is_all_there():
    primary, secondary = pty.openpty()
    words = [sys.executable, "-c", IN_PLACE, json.dumps(ASKED), LOG]
    environment = {**os.environ, "TERM": "xterm-256color"}
    run = subprocess.Popen(words, stdout=secondary, stderr=secondary, env=environment)
    os.close(secondary)
    written = b""
    while True:
        try:
            new = os.read(primary, 65536)
        except OSError:  # the other end is closed
            break
        if not new:
            break
        written += new
    os.close(primary)
    assert run.wait() == 0
    text = written.decode()
    assert text.count("a word of a job") == text.count("the end") == 1
    assert text.index(NAME) < text.index("the end")
    assert "0 of 1 job" in text
    assert "\x1b[?25l" not in text  # a cursor that is hidden stays so after a kill
    assert text.rstrip().endswith("the end")
