"""Still pictures, as PNG, SVG or PDF: a level seen from above, what differs between two, one node's full circle."""

import io
from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from timemap_cli.changes.difference import Difference, Kind
from timemap_cli.errors import UsageError
from timemap_cli.file_names import shown
from timemap_cli.model.estimates import Estimate
from timemap_cli.model.level_map import UNKNOWN, OccupancyGrid, merged_points, occupancy_grid
from timemap_cli.model.nodes import Node
from timemap_cli.reports.quiet_matplotlib import quiet_matplotlib

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure

KIND_COLOURS = {Kind.APPEARED: "#009e73", Kind.VANISHED: "#d55e00", Kind.MOVED: "#0072b2"}  # as on the page
LEVEL_COLOURS = ("#e69f00", "#56b4e9", "#222222", "#cc79a7", "#999933")  # fastest first, as on the page
_NODE_COLOUR = "#2a9d5c"
_UNKNOWN_GREY = 199  # of 255
_LONG_SIDE_IN = 11.0
_SHORT_SIDE_IN = 3.5  # a corridor's picture still has room for its words
_DPI = 80
_FRAME_M = 0.5  # round what is farthest from a node
# What a file would say of itself, by format.
_TOLD = {"png": ("Software",), "svg": ("Date", "Creator"), "pdf": ("CreationDate", "Creator", "Producer")}
_MARGIN_M = 0.1  # between a change and the box round it


@quiet_matplotlib()
def level_picture(
    title: str,
    nodes: Sequence[Node],
    estimates: Mapping[int, Estimate],
    radius: float,
    difference: Difference | None = None,
    *,
    form: str = "png",
) -> bytes:
    """A level: free space white, unknown grey, surfaces the darker the better supported, nodes as dots.

    `radius` [m] is how far a node looks. The changes of `difference` are drawn on top, by kind. `form` is
    "png", "svg" or "pdf". UsageError where matplotlib is not installed.
    """
    grid = occupancy_grid(nodes, estimates, radius)
    figure, axes = _figure(title, *reversed([side * grid.resolution for side in grid.cells.shape]))
    axes.imshow(_shades(grid), origin="lower", extent=_extent(grid), interpolation="nearest")
    x, y, support = merged_points(nodes, estimates).T
    axes.scatter(x, y, c=0.35 - 0.35 * support, s=2.0, cmap="gray", vmin=0, vmax=1, lw=0)
    axes.plot([node.x for node in nodes], [node.y for node in nodes], ".", color=_NODE_COLOUR, ms=3)
    if difference:
        _draw_changes(axes, difference)
    return _drawn(figure, form)


@quiet_matplotlib()
def node_picture(
    title: str, node: Node, levels: Mapping[str, Estimate | None], *, form: str = "png"
) -> bytes:
    """What each level holds around one node, laid over each other; None: a level that never held anything there.

    `levels` has the fastest first; axes in metres from the node, along the map's. UsageError where matplotlib is
    not installed.
    """
    figure, axes = _figure(title, 1.0, 1.0)
    reach = _FRAME_M
    axes.plot([0], [0], "o", color=_NODE_COLOUR, label=f"node at {node.x:.2f}, {node.y:.2f}")
    for place, (level, estimate) in reversed(list(enumerate(levels.items()))):
        held = {} if estimate is None else {0: replace(estimate, node=0)}
        x, y, _ = merged_points([Node(0.0, 0.0)], held).T
        reach = max(reach, float(np.abs([x, y]).max(initial=0.0)) + _FRAME_M)
        colour = LEVEL_COLOURS[place % len(LEVEL_COLOURS)]
        axes.plot(x, y, "o", color=colour, ms=2 + 3 * min(place, 2), mew=0, label=level)
    axes.set(xlim=(-reach, reach), ylim=(-reach, reach))
    axes.legend(loc="upper right")
    return _drawn(figure, form)


def _figure(title: str, width: float, height: float) -> "tuple[Figure, Axes]":
    """A figure of about these proportions."""
    try:
        from matplotlib.figure import Figure
    except ImportError as error:
        raise UsageError(
            "a picture needs matplotlib, which is not installed", hint="pip install 'timemap-cli[plot]'"
        ) from error
    scale = _LONG_SIDE_IN / max(width, height)
    figure = Figure(
        figsize=(max(width * scale, _SHORT_SIDE_IN), max(height * scale, _SHORT_SIDE_IN)), layout="tight"
    )
    axes = figure.add_subplot()
    axes.set_title(shown(title), parse_math=False)  # a file's name may hold any letters: $_$ is no formula
    axes.set(xlabel="x [m]", ylabel="y [m]", aspect="equal")
    return figure, axes


def _shades(grid: OccupancyGrid) -> npt.NDArray[np.uint8]:
    """(rows, columns, 3) grey values."""
    grey = np.where(grid.cells == UNKNOWN, _UNKNOWN_GREY, 255).astype(np.uint8)
    return np.dstack([grey] * 3)


def _extent(grid: OccupancyGrid) -> tuple[float, float, float, float]:
    rows, columns = grid.cells.shape
    left, bottom = grid.origin_x, grid.origin_y
    return left, left + columns * grid.resolution, bottom, bottom + rows * grid.resolution


def _draw_changes(axes: "Axes", difference: Difference) -> None:
    from matplotlib.patches import Rectangle

    named = set()
    for change in difference.changes:
        left, bottom, right, top = change.bounds
        size = right - left + 2 * _MARGIN_M, top - bottom + 2 * _MARGIN_M
        label = None if change.kind in named else change.kind.value
        named.add(change.kind)
        corner = left - _MARGIN_M, bottom - _MARGIN_M
        axes.add_patch(Rectangle(corner, *size, fc="none", ec=KIND_COLOURS[change.kind], lw=2, label=label))
    if named:
        axes.legend(loc="upper right")


def _drawn(figure: "Figure", form: str) -> bytes:
    """The picture's file; the same picture gives the same bytes, which say neither when nor by what."""
    from matplotlib import rc_context

    out = io.BytesIO()
    with rc_context({"svg.hashsalt": "timemap"}):
        figure.savefig(out, format=form, dpi=_DPI, metadata=dict.fromkeys(_TOLD[form]))
    return out.getvalue()
