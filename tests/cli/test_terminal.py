import io
import os

from tests.cli.program import Screen
from timemap_cli.cli.terminal import Terminal
from timemap_cli.errors import TimemapError


def terminal(variables=None, screen=False):
    out, err = (Screen(), Screen()) if screen else (io.StringIO(), io.StringIO())
    return Terminal(out, err, variables or {})


def test_an_error_is_one_line_and_a_line_for_each_thing_to_try():
    here = terminal()
    here.error(TimemapError("two scan topics", hint="--scan-topic /front\n--scan-topic /rear"))
    assert here.stderr.getvalue() == (
        "error: two scan topics\n  try: --scan-topic /front\n  try: --scan-topic /rear\n"
    )
    assert here.stdout.getvalue() == ""


def test_an_error_without_hint_is_one_line():
    here = terminal()
    here.error(TimemapError("disk full"))
    assert here.stderr.getvalue() == "error: disk full\n"


def test_results_go_to_stdout_and_end_with_one_newline():
    here = terminal()
    here.result("one")
    here.result("two\n")
    assert here.stdout.getvalue() == "one\ntwo\n"
    assert here.stderr.getvalue() == ""


def test_words_are_coloured_on_a_terminal_only():
    watched, piped = terminal(screen=True), terminal()
    for here in (watched, piped):
        here.warn("odometry drifts")
    assert watched.stderr.getvalue() == "\x1b[1;33mwarning:\x1b[0m odometry drifts\n"
    assert piped.stderr.getvalue() == "warning: odometry drifts\n"


def test_no_color_and_dumb_terminals_are_respected():
    for variables in ({"NO_COLOR": "1"}, {"TERM": "dumb"}):
        here = terminal(variables, screen=True)
        here.warn("odometry drifts")
        assert here.stderr.getvalue() == "warning: odometry drifts\n"


def test_an_empty_no_color_counts_as_not_set():
    here = terminal({"NO_COLOR": ""}, screen=True)
    here.warn("odometry drifts")
    assert "\x1b[1;33m" in here.stderr.getvalue()


def test_a_reader_that_went_away_is_no_failure():
    read_end, write_end = os.pipe()
    os.close(read_end)
    with os.fdopen(write_end, "w") as stream:
        here = Terminal(stream, io.StringIO(), {})
        here.result("first")
        here.result("second")
    assert here.stderr.getvalue() == ""


ORDERS = "/scan\x1b]0;owned\x07\x9b31m\r\u202e"
SHOWN = "/scan\\x1b]0;owned\\x07\\x9b31m\\r\\u202e"


def test_names_that_would_give_orders_to_the_terminal_are_shown_escaped():
    here = terminal()
    here.result(ORDERS)
    here.warn(ORDERS)
    here.note(ORDERS)
    here.error(TimemapError(ORDERS, hint=ORDERS))
    assert here.stdout.getvalue() == f"{SHOWN}\n"
    assert here.stderr.getvalue() == f"warning: {SHOWN}\n{SHOWN}\nerror: {SHOWN}\n  try: {SHOWN}\n"


def test_a_line_feed_in_a_name_forges_no_line():
    here = terminal()
    here.warn("no pose for /scan\nerror: all is lost")
    here.error(TimemapError("no topic /scan\n  try: rm"))
    assert here.stderr.getvalue() == (
        "warning: no pose for /scan\\nerror: all is lost\nerror: no topic /scan\\n  try: rm\n"
    )


def test_letters_of_all_languages_are_left_alone():
    here = terminal()
    here.result("/größe\t廊下 \N{ROBOT FACE}\nที่ว่าง")
    assert here.stdout.getvalue() == "/größe\t廊下 \N{ROBOT FACE}\nที่ว่าง\n"
