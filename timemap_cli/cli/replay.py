"""`timemap replay`: recordings in, one result file out."""

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import click

from timemap_cli.cli.outputs import RESULT, require_file, required_suffix
from timemap_cli.cli.paths import NAMED_PATH
from timemap_cli.cli.progress import ProgressBar
from timemap_cli.cli.terminal import Terminal
from timemap_cli.config import PROFILES, Settings, load
from timemap_cli.errors import ExitCode, UsageError

if TYPE_CHECKING:
    from timemap_cli.replay import ReplaySummary

_SUFFIXES = (".mcap", ".bag", ".db3", ".zstd")


@click.command(short_help="replay recordings into a result file")
@click.argument("logs", nargs=-1, required=True, type=NAMED_PATH, metavar="LOG...")
@click.option(
    "-o",
    "--output",
    type=NAMED_PATH,
    metavar="OUT.mcap",
    help="Result. [default: LOG's name with .timemap.mcap, here]",
)
@click.option("--force", is_flag=True, help="Replace an existing result.")
@click.option(
    "--config", "config_file", type=NAMED_PATH, metavar="FILE", help="Settings file; see 'timemap config'."
)
@click.option(
    "--scan-topic", "scan_topics", multiple=True, metavar="TOPIC", help="Laser scans to use; may be repeated."
)
@click.option("--map-frame", metavar="FRAME", help="Frame in which the nodes stand.")
@click.option("--poses", metavar="tf|TOPIC", help="Where the robot's pose comes from.")
@click.option(
    "--no-return",
    type=click.Choice(["auto", "clear", "ignore"]),
    help="What a beam that did not come back means.",
)
@click.option(
    "--max-dropped",
    type=float,
    metavar="SHARE",
    help="Share of scans that may be lost before exit code 3.",
)
@click.option(
    "--start",
    metavar="TIME",
    help="Leave out scans before: a date, RFC 3339, +10s, or 2d for the last 2 days.",
)
@click.option("--end", metavar="TIME", help="Leave out scans from here on.")
@click.option(
    "--nodes", type=NAMED_PATH, metavar="FILE", help="Use these nodes: an earlier result, or a list of x y."
)
@click.option(
    "--resume",
    type=NAMED_PATH,
    metavar="RESULT",
    help="Go on from an earlier result, with its settings.",
)
@click.option("--seed", type=int, metavar="N", help="Another seed draws other samples.")
@click.option("--profile", type=click.Choice(PROFILES), help="Defaults below the settings file.")
@click.option("--json", "as_json", is_flag=True, help="Print JSON (schema timemap.replay/1).")
@click.option("-q", "--quiet", is_flag=True, help="No progress bar and no summary.")
@click.pass_obj
def replay(
    terminal: Terminal,
    /,
    logs: tuple[Path, ...],
    output: Path | None,
    force: bool,
    config_file: Path | None,
    start: str | None,
    end: str | None,
    nodes: Path | None,
    resume: Path | None,
    as_json: bool,
    quiet: bool,
    **flags: Any,
) -> ExitCode:
    """Replay the recordings LOG... in time order into one result file.

    LOG is a ROS 1 bag, a ROS 2 bag (folder or single file) or an MCAP file. Topics, frames and poses are
    found where there is one choice. Settings: defaults, then --config, then the options.

    Exit code 3: done, but data was lost (a recording is cut off, or too many scans had to be dropped).
    """
    result = output or default_output(logs[0])
    require_file(result, "a result", "-o OUT.mcap")
    inputs = {
        "recording": logs,
        "settings file": [config_file],
        "nodes": [nodes],
        "earlier result": [resume],
    }
    _refuse_own_input(result, inputs)
    required_suffix(result, RESULT, "a result")
    settings = load(config_file, _overrides(**flags), _earlier_settings(resume, nodes))

    from timemap_cli import replay as replaying

    with ProgressBar(terminal, quiet=quiet) as progress:
        summary = replaying.replay(
            logs,
            result,
            settings,
            force=force,
            nodes=nodes,
            start=start,
            end=end,
            resume=resume,
            progress=progress,
        )
    return _tell(terminal, summary, as_json, quiet)


def default_output(first_log: Path) -> Path:
    """`<first log's name>.timemap.mcap` in the current folder."""
    name = first_log.resolve().name if first_log.name in ("", "..") else first_log.name
    for suffix in reversed(_SUFFIXES):
        name = name.removesuffix(suffix)
    return Path(f"{name}.timemap.mcap")


def _earlier_settings(resume: Path | None, nodes: Path | None) -> Settings | None:
    """What settings are that nobody states."""
    if resume is None:
        return None
    if nodes is not None:
        raise UsageError(
            "--nodes and --resume exclude each other: the nodes are those of the earlier result",
            hint="leave --nodes out",
        )
    from timemap_cli.resuming import Earlier

    return Earlier.of(resume).settings


def _overrides(
    scan_topics: tuple[str, ...],
    map_frame: str | None,
    poses: str | None,
    no_return: str | None,
    max_dropped: float | None,
    seed: int | None,
    profile: str | None,
) -> dict[str, Any]:
    """The options that were given, in the shape of a settings file."""
    given = {
        "map_frame": map_frame,
        "poses": poses,
        "no_return": no_return,
        "max_dropped": max_dropped,
        "scan_topics": scan_topics or None,
    }
    top = {"input": {key: value for key, value in given.items() if value is not None}}
    return top | {key: value for key, value in (("seed", seed), ("profile", profile)) if value is not None}


def _refuse_own_input(output: Path, inputs: Mapping[str, Sequence[Path | None]]) -> None:
    """UsageError if the result would replace something that is read, or lie within it."""
    target = output.resolve()
    for what, paths in inputs.items():
        for path in paths:
            if path is not None and path.resolve() in (target, target.parent):
                verb = "are" if what == "nodes" else "is"
                raise UsageError(
                    f"the result {output} would stand where the {what} {path} {verb}", hint="-o OUT.mcap"
                )


def _tell(terminal: Terminal, summary: "ReplaySummary", as_json: bool, quiet: bool) -> ExitCode:
    from timemap_cli.cli.summary import replay_json, replay_text

    for warning in summary.warnings:
        terminal.warn(warning)
    if as_json:
        terminal.result(replay_json(summary))
    elif not quiet:
        terminal.result(replay_text(summary))
    return ExitCode.DATA_LOST if summary.data_lost else ExitCode.DONE
