"""The places of the map that remember."""

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class Node:
    """A place of the map; bearing 0 looks along the map's +x. Its number is its place in the list of nodes."""

    x: float  # [m] map frame
    y: float  # [m] map frame
