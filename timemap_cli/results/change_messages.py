"""The messages that tell of change events: one per transition, and the same as markers to look at."""

from collections.abc import Sequence

from timemap_cli.changes.difference import Kind
from timemap_cli.changes.events import Event, Transition, Turn
from timemap_cli.changes.hull import hull
from timemap_cli.results.cdr import CdrBuilder

_LINE_STRIP, _TEXT = 4, 9  # visualization_msgs/Marker
_ADD, _DELETE = 0, 2
_LINE_WIDTH_M, _TEXT_HEIGHT_M, _TEXT_Z_M = 0.04, 0.2, 0.3
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


def pack_markers(transitions: Sequence[Transition], stamp_ns: int, map_frame: str) -> bytes:
    """`visualization_msgs/MarkerArray`: an outline and a text for every event that holds; deleted when it is undone."""
    newest = {transition.event.id: transition for transition in transitions}  # the last word on each
    cdr = CdrBuilder()
    cdr.pack("I", 2 * len(newest))
    for transition in newest.values():
        event = transition.event
        action = _ADD if event.holds and transition.turn is not Turn.DROPPED else _DELETE
        for name, kind in (("outline", _LINE_STRIP), ("text", _TEXT)):
            cdr.header(stamp_ns, map_frame)
            cdr.string(f"timemap/{name}")
            cdr.pack("i", event.id, kind, action)
            _marker_body(cdr, event, kind)
    return cdr.message()


def _marker_body(cdr: CdrBuilder, event: Event, kind: int) -> None:
    x, y = event.centre
    is_text = kind == _TEXT
    cdr.pack("d", *((x, y, _TEXT_Z_M) if is_text else (0.0, 0.0, 0.0)))
    cdr.pack("d", 0.0, 0.0, 0.0, 1.0)
    cdr.pack("d", *((0.0, 0.0, _TEXT_HEIGHT_M) if is_text else (_LINE_WIDTH_M, 0.0, 0.0)))
    cdr.pack("f", *COLOURS[event.kind], 1.0)
    cdr.pack("i", 0)  # lifetime: until it is deleted
    cdr.pack("I", 0)
    cdr.pack("B", False)  # frame_locked
    corners = hull(event.points)
    _points(cdr, [] if is_text else [*corners.tolist(), corners[0].tolist()])
    cdr.pack("I", 0)  # colors
    cdr.string("")  # texture_resource
    cdr.header(0, "")  # texture
    cdr.string("")
    cdr.pack("I", 0)
    cdr.pack("I", 0)  # uv_coordinates
    cdr.string(f"{event.id} {event.kind.value}" if is_text else "")
    cdr.string("")  # mesh_resource
    cdr.string("")  # mesh_file
    cdr.pack("I", 0)
    cdr.pack("B", False)  # mesh_use_embedded_materials


def _points(cdr: CdrBuilder, points: Sequence[Sequence[float]]) -> None:
    cdr.pack("I", len(points))
    for x, y in points:
        cdr.pack("d", x, y, 0.0)


def _times(cdr: CdrBuilder, stamps_ns: Sequence[int]) -> None:
    cdr.pack("I", len(stamps_ns))
    for stamp_ns in stamps_ns:
        cdr.time(stamp_ns)
