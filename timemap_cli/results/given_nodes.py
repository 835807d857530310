"""Nodes that are given beforehand: those of an earlier result, or a list of places."""

import math
from pathlib import Path

from timemap_cli.errors import TimemapError, UsageError, no_such_file, refuse_pipe
from timemap_cli.model.nodes import Node
from timemap_cli.model.placement import MOST_NODES
from timemap_cli.results.reader import ResultReader

_FORM = "one line `x, y` in metres of the map frame for each node"
_MCAP_MAGIC = b"\x89MCAP"


def read_nodes(path: Path, map_frame: str) -> tuple[Node, ...]:
    """Nodes of an earlier result, or of a text file with lines `x, y` or `x y` [m, map frame]; `x, y` may come first.

    What follows a `#` is no part of a line. UsageError where there is no such file, no node in it, more than there
    may be, two at the same place, or a result in another frame than `map_frame`; TimemapError where it cannot be read.
    """
    nodes = _read(path, map_frame)
    if len(nodes) > MOST_NODES:
        raise UsageError(f"{path} holds {len(nodes)} nodes, a map has {MOST_NODES} at most", hint=_FORM)
    return nodes


def _read(path: Path, map_frame: str) -> tuple[Node, ...]:
    refuse_pipe(path)
    try:
        data = path.read_bytes() if path.is_file() else None
    except OSError as error:
        raise TimemapError(f"cannot read {path}: {error.strerror}") from error
    if data is None:
        raise no_such_file(path, "--nodes NODES.csv, or an earlier result")
    if data.startswith(_MCAP_MAGIC):
        with ResultReader(path) as result:
            if result.map_frame != map_frame:
                raise UsageError(
                    f"the nodes of {path} stand in '{result.map_frame}', the poses are in '{map_frame}'",
                    hint=f"a result whose nodes stand in '{map_frame}', or a list of places",
                )
            return tuple(result.nodes)
    lines = [line.partition("#")[0].strip() for line in data.decode(errors="replace").splitlines()]
    numbered = [(number, line) for number, line in enumerate(lines, 1) if line]
    if numbered and numbered[0][1].lower().replace(",", " ").split() == ["x", "y"]:
        del numbered[0]
    if not numbered:
        raise UsageError(f"{path} holds no nodes", hint=_FORM)
    lines_of: dict[Node, int] = {}
    for number, line in numbered:
        node = _node(path, number, line)
        if node in lines_of:
            raise UsageError(
                f"{path}, line {number}: the node of line {lines_of[node]} stands there", hint=_FORM
            )
        lines_of[node] = number
    return tuple(lines_of)


def _node(path: Path, number: int, line: str) -> Node:
    try:
        x, y = (round(float(value), 3) for value in line.replace(",", " ").split())
    except ValueError:
        x = y = math.nan
    if not (math.isfinite(x) and math.isfinite(y)):
        raise UsageError(f"{path}, line {number}: '{line[:40]}' is not a place `x, y` in metres", hint=_FORM)
    return Node(x, y)
