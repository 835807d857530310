"""The program as a function of its arguments and its terminal, and its commands."""

from collections.abc import Sequence
from contextlib import redirect_stderr, redirect_stdout
from io import StringIO

import click

from timemap_cli import __version__
from timemap_cli.cli.changes import changes
from timemap_cli.cli.check import check
from timemap_cli.cli.completion import VARIABLE, completion
from timemap_cli.cli.config import config
from timemap_cli.cli.diff import diff
from timemap_cli.cli.info import info
from timemap_cli.cli.plot import plot
from timemap_cli.cli.replay import replay
from timemap_cli.cli.report import report
from timemap_cli.cli.terminal import Terminal
from timemap_cli.errors import ExitCode, TimemapError, UsageError, as_expected


@click.group(context_settings={"help_option_names": ["-h", "--help"], "max_content_width": 100})
@click.version_option(__version__, prog_name="timemap", message="%(prog)s %(version)s")
def timemap() -> None:
    """Replay recorded laser scans through a map that remembers at several time scales.

    It says what changed, where, and at which time scale.

    \b
      timemap replay monday.mcap tuesday.mcap
      timemap changes
      timemap diff --level long mid
    """


for _command in (info, replay, changes, diff, report, plot, check, config):
    timemap.add_command(_command)


def main(args: Sequence[str], terminal: Terminal | None = None) -> int:
    """Run one command and return its exit code; what a user can mend becomes one error on stderr."""
    terminal = terminal or Terminal()
    try:
        return _exit_code(args, terminal)
    except TimemapError as error:
        terminal.error(error)
        return error.exit_code
    except (OSError, MemoryError) as error:
        terminal.error(as_expected(error))
        return ExitCode.FAILED
    except (KeyboardInterrupt, click.Abort) as error:
        if isinstance(error.__cause__, EOFError):  # click takes it for Ctrl-D at a prompt; there are none
            hint = "install timemap anew: a full disk may have cut its compiled files"
            terminal.error(
                TimemapError(f"a file of the program itself ends too early: {error.__cause__}", hint=hint)
            )
            return ExitCode.FAILED
        terminal.note("interrupted")
        return ExitCode.INTERRUPTED


def _exit_code(args: Sequence[str], terminal: Terminal) -> int:
    """The code that the command returned; click's own complaints become a UsageError."""
    told = StringIO()  # what click prints: help and version
    try:
        with redirect_stdout(told), redirect_stderr(terminal.stderr):
            if instruction := terminal.variables.get(VARIABLE):
                told.write(completion(timemap, instruction))
                return ExitCode.DONE
            code = timemap.main(list(args), prog_name="timemap", standalone_mode=False, obj=terminal)
    except click.exceptions.NoArgsIsHelpError as error:
        terminal.note(error.ctx.get_help() if error.ctx else "")
        return ExitCode.USAGE
    except click.UsageError as error:
        command = error.ctx.command_path if error.ctx else "timemap"
        raise UsageError(_sentence(error.format_message()), hint=f"{command} --help") from error
    except click.ClickException as error:
        raise UsageError(_sentence(error.format_message())) from error
    finally:
        if told.getvalue():
            terminal.result(told.getvalue())
    return int(code or ExitCode.DONE)


def _sentence(text: str) -> str:
    """Click's complaint in the form of our own: no capital at its start, no full stop at its end."""
    return text[:1].lower() + text[1:].rstrip(".")
