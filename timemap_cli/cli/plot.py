"""`timemap plot`: still pictures of a result."""

from pathlib import Path
from typing import TYPE_CHECKING

import click

from timemap_cli.cli.chosen import chosen_result, title_of
from timemap_cli.cli.level_words import LevelPairs
from timemap_cli.cli.outputs import is_standard_output, required_suffix, write_output
from timemap_cli.cli.paths import NAMED_PATH
from timemap_cli.cli.terminal import Terminal
from timemap_cli.errors import ExitCode, UsageError

if TYPE_CHECKING:
    from timemap_cli.results.reader import ResultReader

_HEADS = {  # how a picture that may be replaced begins, by its suffix
    ".png": b"\x89PNG\r\n\x1a\n",
    ".svg": b'<?xml version="1.0" encoding="utf-8" standalone="no"?>\n<!DOCTYPE svg ',
    ".pdf": b"%PDF-",
}


@click.command(cls=LevelPairs, short_help="a still picture: a level, what differs between two, or a node")
@click.argument("result", required=False, type=NAMED_PATH)
@click.option(
    "-o",
    "--output",
    type=NAMED_PATH,
    metavar="PICTURE.png",
    help="Picture: .png, .svg or .pdf; - is standard output. [default: RESULT's name with .png, here]",
)
@click.option(
    "--level",
    "levels",
    multiple=True,
    metavar="LEVEL [LEVEL]",
    help="The level to draw, or two: the slower one, and what differs from it in the faster. [default: the slowest]",
)
@click.option(
    "--node", type=click.IntRange(0), metavar="N", help="Draw what each level holds around this node."
)
@click.option("--force", is_flag=True, help="Replace an existing picture.")
@click.pass_obj
def plot(
    terminal: Terminal,
    /,
    result: Path | None,
    output: Path | None,
    levels: tuple[str, ...],
    node: int | None,
    force: bool,
) -> ExitCode:
    """Draw RESULT as a PNG, or as what the suffix of its name says: PNG, SVG or PDF.

    Free space is white, unknown space grey, and a surface the darker the better supported. Without RESULT, the
    newest *.timemap.mcap in the current folder is taken. Needs matplotlib: pip install 'timemap-cli[plot]'.
    """
    from timemap_cli.results.reader import ResultReader

    _check_usage(levels, node)
    named = output is not None and not is_standard_output(output)
    suffix = required_suffix(output, tuple(_HEADS), "a picture") if output and named else ".png"
    result = chosen_result(terminal, result)
    title = title_of(result)
    output = output or Path(title + ".png")
    form = suffix[1:]
    with ResultReader(result) as reader:
        write_output(
            terminal,
            output,
            lambda: _level(reader, levels, title, form) if node is None else _node(reader, node, title, form),
            force=force,
            heads=[_HEADS[suffix]],
            replaced=f"a {form.upper()} picture",
        )
    return ExitCode.DONE


def _check_usage(levels: tuple[str, ...], node: int | None) -> None:
    if len(levels) > 2:
        raise UsageError(
            f"{len(levels)} levels given: {', '.join(levels)}", hint="timemap plot --level long mid"
        )
    if levels and node is not None:
        raise UsageError(
            "a node is drawn with all its levels, without --level", hint=f"timemap plot --node {node}"
        )


def _level(reader: "ResultReader", levels: tuple[str, ...], title: str, form: str) -> bytes:
    from timemap_cli.comparing import compare_levels, require_level
    from timemap_cli.reports.pictures import level_picture

    if len(levels) < 2:
        level, difference = levels[0] if levels else reader.levels[-1], None
        hint = f"timemap plot {reader.path} --level {reader.levels[-1]}"
        require_level(reader, reader.path, level, hint)
        title = f"{title}: {level}"
    else:
        comparison = compare_levels(reader.path, (levels[0], levels[1]))
        level, difference = comparison.before.level, comparison.difference
        title = f"{title}: {level}, and what differs in {comparison.after.level}"
    return level_picture(title, reader.nodes, reader.estimates(level), reader.radius, difference, form=form)


def _node(reader: "ResultReader", node: int, title: str, form: str) -> bytes:
    from timemap_cli.reports.pictures import node_picture

    if node >= len(reader.nodes):
        raise UsageError(
            f"{reader.path} has no node {node}, only 0 to {len(reader.nodes) - 1}",
            hint=f"timemap plot {reader.path} --node {len(reader.nodes) - 1}",
        )
    held = {level: reader.estimates(level).get(node) for level in reader.levels}
    return node_picture(f"{title}: node {node}", reader.nodes[node], held, form=form)
