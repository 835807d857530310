"""What a check compares: the end of a result, in coarse figures."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from timemap_cli.model.nodes import Node

Floats = npt.NDArray[np.float64]
Bools = npt.NDArray[np.bool_]


_MOST_BINS = 25_000_000  # of all nodes and levels, 200 MB; three levels of a thousand nodes are a million


def require_comparable_size(nodes: int, angle_bins: int, levels: int) -> None:
    """ValueError for a map of more angle bins than are held at once."""
    if nodes * angle_bins * levels > _MOST_BINS:
        told = f"{levels} levels of {nodes} nodes with {angle_bins} angle bins"
        raise ValueError(f"{told} are more than the {_MOST_BINS} angle bins that can be compared")


@dataclass(frozen=True, slots=True)
class Input:
    """A recording."""

    name: str
    sha256: str


@dataclass(frozen=True, slots=True)
class SeenEvent:
    """A change event in coarse figures; times are in whole seconds."""

    kind: str
    x: float  # [m] map frame
    y: float
    size: float  # [m] diagonal
    nodes: int  # that could tell, by their newest word
    since_ns: int
    until_ns: int | None
    adopted: tuple[str, ...]  # levels


@dataclass(frozen=True, slots=True)
class LevelRings:
    """What one level holds at all nodes; a node that it does not know has no digest and unknown bins."""

    ranges: Floats  # (nodes, angle_bins) [m], to the centimetre; +inf clear, NaN unknown
    support: Floats  # (nodes,) mean over the known bins
    digests: tuple[str, ...]  # by node, of ranges in millimetres, statuses and samples


@dataclass(frozen=True, slots=True)
class Scans:
    """What became of the scans."""

    read: int
    used: int
    dropped: Mapping[str, int]  # by reason


@dataclass(frozen=True, slots=True)
class Snapshot:
    """A result's end, or what it is expected to be."""

    version: str
    inputs: tuple[Input, ...]
    settings: Mapping[str, object]  # whole name -> value: {"map.radius": 10.0}
    map_frame: str
    radius: float  # [m]
    angle_bins: int
    no_return: str  # what a missing return counted as: "clear" or "ignore"
    beams: Mapping[
        str, Mapping[str, float]
    ]  # scan topic -> kind of beam -> share of it; none where not known
    scans: Scans
    nodes: Sequence[Node]
    levels: Mapping[str, LevelRings]  # fastest first
    events: tuple[SeenEvent, ...]
    laid: bool | None = None  # nodes were made on the way, not known from the start; None: not known
