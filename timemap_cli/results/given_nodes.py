"""Nodes that are given beforehand: those of an earlier result, or a list of places."""

import math
from pathlib import Path

from timemap_cli.errors import TimemapError, UsageError
from timemap_cli.model.nodes import Node
from timemap_cli.results.reader import ResultReader

_MCAP_MAGIC = b"\x89MCAP"


def read_nodes(path: Path, map_frame: str) -> tuple[Node, ...]:
    """Nodes of an earlier result, or of a text file with lines `x, y` or `x y` [m, map frame]; `x, y` may come first.

    UsageError where there is no such file, no node in it, or a result in another frame than `map_frame`; TimemapError
    where it cannot be read.
    """
    try:
        data = path.read_bytes() if path.is_file() else None
    except OSError as error:
        raise TimemapError(f"cannot read {path}: {error.strerror}") from error
    if data is None:
        raise UsageError(f"there is no file {path}", hint="--nodes NODES.csv, or an earlier result")
    if data.startswith(_MCAP_MAGIC):
        with ResultReader(path) as result:
            if result.map_frame != map_frame:
                raise UsageError(
                    f"the nodes of {path} stand in '{result.map_frame}', the poses are in '{map_frame}'",
                    hint=f"--map-frame {result.map_frame}, or another result",
                )
            return tuple(result.nodes)
    lines = [line.strip() for line in data.decode(errors="replace").splitlines()]
    if lines and lines[0].lower().replace(",", " ").split() == ["x", "y"]:
        lines[0] = ""
    nodes = tuple(_node(path, number, line) for number, line in enumerate(lines, 1) if line)
    if not nodes:
        raise UsageError(f"{path} holds no nodes", hint="one line `x, y` in metres for each node")
    return nodes


def _node(path: Path, number: int, line: str) -> Node:
    try:
        x, y = (round(float(value), 3) for value in line.replace(",", " ").split())
    except ValueError:
        x = y = math.nan
    if not (math.isfinite(x) and math.isfinite(y)):
        raise UsageError(f"{path}, line {number}: '{line[:40]}' is not a place `x, y` in metres")
    return Node(x, y)
