"""The messages that tell of change events: one per transition, and what holds as markers to look at."""

from collections.abc import Iterator, Sequence
from dataclasses import dataclass

from timemap_cli.changes.difference import Kind
from timemap_cli.changes.events import Event, Transition
from timemap_cli.changes.hull import hull
from timemap_cli.results.cdr import CdrBuilder

_LINE_STRIP, _TEXT = 4, 9  # visualization_msgs/Marker
_ADD, _DELETE_ALL = 0, 3
_LINE_WIDTH_M, _TEXT_HEIGHT_M, _TEXT_APART_M = 0.04, 0.2, 0.2
_OUTLINE_Z_M, _TEXT_Z_M = 0.1, 0.3  # above the points and grids, which lie at 0
# Okabe and Ito's colours, told apart by every kind of eye.
COLOURS = {
    Kind.APPEARED: (0.0, 0.62, 0.45),
    Kind.VANISHED: (0.84, 0.37, 0.0),
    Kind.MOVED: (0.0, 0.45, 0.7),
}


def pack_change(transition: Transition, stamp_ns: int, map_frame: str) -> bytes:
    """`timemap_msgs/Change`."""
    event = transition.event
    adopted = {level: at_ns for level, at_ns in event.adopted.items() if at_ns is not None}
    cdr = CdrBuilder()
    cdr.header(stamp_ns, map_frame)
    cdr.pack("I", event.id)
    for text in (transition.turn.value, transition.level or "", event.kind.value):
        cdr.string(text)
    _points(cdr, hull(event.points).tolist())
    _points(cdr, [event.moved_from] if event.moved_from else [])
    cdr.pack("f", event.support)
    for at_ns in (event.first_seen_ns, event.last_seen_ns, event.looked_ns):
        cdr.time(at_ns)
    cdr.pack("I", len(adopted))
    for level in adopted:
        cdr.string(level)
    _times(cdr, list(adopted.values()))
    for nodes in (event.nodes, event.against):
        cdr.pack("I", len(nodes), *nodes)
    _times(cdr, [episode.since_ns for episode in event.episodes])
    _times(cdr, [episode.until_ns for episode in event.episodes if episode.until_ns is not None])
    cdr.pack("f", event.share_held)
    return cdr.message()


def pack_markers(events: Sequence[Event], stamp_ns: int, map_frame: str) -> bytes:
    """`visualization_msgs/MarkerArray`: an outline and a text for each of the events that holds, and nothing else.

    It first deletes all markers of the topic, since a viewer that jumps in time or begins late takes the newest
    message only.
    """
    markers = [_Marker(action=_DELETE_ALL), *_markers(events)]
    cdr = CdrBuilder()
    cdr.pack("I", len(markers))
    for marker in markers:
        cdr.header(stamp_ns, map_frame)
        marker.write(cdr)
    return cdr.message()


@dataclass(frozen=True, slots=True)
class _Marker:
    """What our markers differ in; lengths in metres, map frame."""

    namespace: str = ""  # none: of all
    id: int = 0
    type: int = 0
    action: int = _ADD
    position: tuple[float, float, float] = (0.0, 0.0, 0.0)
    scale: tuple[float, float, float] = (0.0, 0.0, 0.0)
    colour: tuple[float, float, float] = (0.0, 0.0, 0.0)
    points: Sequence[Sequence[float]] = ()
    text: str = ""

    def write(self, cdr: CdrBuilder) -> None:
        """`visualization_msgs/Marker` after its header."""
        cdr.string(self.namespace)
        cdr.pack("i", self.id, self.type, self.action)
        cdr.pack("d", *self.position)
        cdr.pack("d", 0.0, 0.0, 0.0, 1.0)
        cdr.pack("d", *self.scale)
        cdr.pack("f", *self.colour, 1.0)
        cdr.pack("i", 0)  # lifetime: until it is deleted
        cdr.pack("I", 0)
        cdr.pack("B", False)  # frame_locked
        _points(cdr, self.points)
        cdr.pack("I", 0)  # colors
        cdr.string("")  # texture_resource
        cdr.header(0, "")  # texture
        cdr.string("")
        cdr.pack("I", 0)
        cdr.pack("I", 0)  # uv_coordinates
        cdr.string(self.text)
        cdr.string("")  # mesh_resource
        cdr.string("")  # mesh_file
        cdr.pack("I", 0)
        cdr.pack("B", False)  # mesh_use_embedded_materials


def _markers(events: Sequence[Event]) -> Iterator[_Marker]:
    for event in events:
        if not event.holds:
            continue
        colour, corners = COLOURS[event.kind], hull(event.points).tolist()
        x_min, _, x_max, y_max = event.bounds
        yield _Marker(
            "timemap/outline",
            event.id,
            _LINE_STRIP,
            position=(0.0, 0.0, _OUTLINE_Z_M),
            scale=(_LINE_WIDTH_M, 0.0, 0.0),
            colour=colour,
            points=[*corners, corners[0]],
        )
        yield _Marker(
            "timemap/text",
            event.id,
            _TEXT,
            position=((x_min + x_max) / 2, y_max + _TEXT_APART_M, _TEXT_Z_M),
            scale=(0.0, 0.0, _TEXT_HEIGHT_M),
            colour=colour,
            text=f"{event.id} {event.kind.value}",
        )


def _points(cdr: CdrBuilder, points: Sequence[Sequence[float]]) -> None:
    cdr.pack("I", len(points))
    for x, y in points:
        cdr.pack("d", x, y, 0.0)


def _times(cdr: CdrBuilder, stamps_ns: Sequence[int]) -> None:
    cdr.pack("I", len(stamps_ns))
    for stamp_ns in stamps_ns:
        cdr.time(stamp_ns)
