"""What is said of change events, decoded by rosbags with nothing but the definitions that a result embeds."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from rosbags.typesys import Stores, get_types_from_msg, get_typestore

from tests.results.events import event
from tests.results.rooms import SECOND, T0
from timemap_cli.changes.difference import Kind
from timemap_cli.changes.events import Episode, Transition, Turn
from timemap_cli.results import definitions
from timemap_cli.results.change_messages import pack_change, pack_markers

ADD, DELETE_ALL = 0, 3  # visualization_msgs/Marker
LINE_STRIP, TEXT = 4, 9
frames = st.text("abcdefgh_/", min_size=1, max_size=12)
places = st.floats(-1e4, 1e4)
kinds = st.sampled_from(Kind)


def embedded(msgtype):
    store = get_typestore(Stores.EMPTY)
    store.register(get_types_from_msg(definitions.definition(msgtype), msgtype))
    return store


STORES = {msgtype: embedded(msgtype) for msgtype in (definitions.CHANGE, definitions.MARKERS)}


def decoded(raw, msgtype):
    """The message, once it is certain that not one byte of it is other than rosbags would write."""
    message = STORES[msgtype].deserialize_cdr(raw, msgtype)
    assert bytes(STORES[msgtype].serialize_cdr(message, msgtype)) == raw
    return message


def change(found, frame="map"):
    return decoded(pack_change(found, T0, frame), definitions.CHANGE)


def markers(*events, frame="map"):
    return decoded(pack_markers(events, T0, frame), definitions.MARKERS).markers


def nanoseconds(time):
    return time.sec * SECOND + time.nanosec


def corners(points):
    return [(point.x, point.y, point.z) for point in points]


def test_marker_array_is_that_of_ros_2_humble():
    humble = get_typestore(Stores.ROS2_HUMBLE)
    assert STORES[definitions.MARKERS].hash_rihs01(definitions.MARKERS) == humble.hash_rihs01(
        definitions.MARKERS
    )


def test_a_change_tells_all_that_is_known_of_its_event():
    episodes = (Episode(T0, T0 + 3), Episode(T0 + 5, T0 + 6), Episode(T0 + 8, None))
    told = change(
        Transition(
            Turn.ADOPTED,
            event(
                kind=Kind.MOVED,
                moved_from=(4.5, -1.25),
                adopted={"short": T0 + 1, "mid": T0 + 4, "long": None},
                nodes=(0, 2, 5),
                against=(3,),
                episodes=episodes,
            ),
            "mid",
        )
    )
    assert (told.header.frame_id, nanoseconds(told.header.stamp)) == ("map", T0)
    assert (told.id, told.turn, told.level, told.kind) == (7, "adopted", "mid", "moved")
    assert corners(told.moved_from) == [(4.5, -1.25, 0.0)]
    assert (told.support, told.share_held) == (0.75, 0.75)
    seen = [nanoseconds(time) for time in (told.first_seen, told.last_seen, told.looked)]
    assert seen == [T0, T0 + SECOND, T0 + 2 * SECOND]
    assert told.adopted_levels == ["short", "mid"]
    assert [nanoseconds(time) for time in told.adopted] == [T0 + 1, T0 + 4]
    assert (told.nodes.tolist(), told.against.tolist()) == ([0, 2, 5], [3])
    assert [nanoseconds(time) for time in told.since] == [T0, T0 + 5, T0 + 8]
    assert [nanoseconds(time) for time in told.until] == [T0 + 3, T0 + 6]


def test_outline_goes_round_the_points_at_a_margin_of_2_5_cm():
    told = change(Transition(Turn.SEEN, event()))
    around = {(0.975, 1.975, 0.0), (2.025, 1.975, 0.0), (2.025, 3.025, 0.0), (0.975, 3.025, 0.0)}
    assert set(corners(told.outline)) == around
    outline, _ = markers(event())[1:]
    assert set(corners(outline.points)) == around
    assert len(outline.points) == 5
    assert outline.points[0] == outline.points[-1], "a line strip that is closed"


def test_what_is_not_known_is_empty():
    told = change(Transition(Turn.SEEN, event(adopted={"short": None}, nodes=())))
    assert told.level == ""
    assert not told.moved_from
    assert not told.adopted_levels
    assert not told.adopted
    assert (told.nodes.tolist(), told.against.tolist()) == ([], [])


@pytest.mark.parametrize("turn", Turn)
def test_every_turn_is_named_in_the_definition(turn):
    (line,) = [part for part in definitions.definition(definitions.CHANGE).splitlines() if " turn " in part]
    assert change(Transition(turn, event())).turn in line.partition("#")[2].replace(",", "").split()


@given(frames, kinds, st.lists(st.tuples(places, places), min_size=1, max_size=6), st.integers(0, 2**31 - 1))
def test_any_event_is_what_a_ros_client_would_write(frame, kind, points, number):
    one = event(number, kind=kind, points=np.array(points))
    told = change(Transition(Turn.CLOSED, one), frame)
    assert (told.header.frame_id, told.id, told.kind) == (frame, number, kind.value)
    cleared, outline, text = markers(one, frame=frame)
    assert {m.header.frame_id for m in (cleared, outline, text)} == {frame}
    assert len(outline.points) > 3


def test_markers_are_an_outline_and_a_text_of_every_event_that_holds():
    told = markers(event(3), event(5, kind=Kind.VANISHED))
    assert [(m.ns, m.id, m.type, m.action) for m in told[1:]] == [
        ("timemap/outline", 3, LINE_STRIP, ADD),
        ("timemap/text", 3, TEXT, ADD),
        ("timemap/outline", 5, LINE_STRIP, ADD),
        ("timemap/text", 5, TEXT, ADD),
    ]
    assert [m.text for m in told[1:]] == ["", "3 appeared", "", "5 vanished"]


def test_text_stands_beside_the_outline_and_not_on_it():
    _, outline, text = markers(event())
    assert text.pose.position.x == 1.5
    lower_edge = text.pose.position.y - text.scale.z / 2
    assert lower_edge > max(point.y for point in outline.points) + outline.scale.x / 2


def test_markers_stay_until_they_are_deleted():
    for marker in markers(event()):
        assert (marker.lifetime.sec, marker.lifetime.nanosec, marker.frame_locked) == (0, 0, False)
        assert nanoseconds(marker.header.stamp) == T0


def test_an_event_that_is_undone_has_no_marker_and_one_that_came_back_has():
    undone = event(3, until_ns=T0 + 1)
    back = event(4, episodes=(Episode(T0, T0 + 1), Episode(T0 + 2, None)))
    assert [(m.ns, m.id) for m in markers(undone, back)[1:]] == [("timemap/outline", 4), ("timemap/text", 4)]


@pytest.mark.parametrize("events", [(), (event(3, until_ns=T0 + 1),), (event(3), event(4))])
def test_every_message_first_deletes_all_that_a_viewer_may_still_show(events):
    first, *others = markers(*events)
    assert (first.action, first.ns) == (DELETE_ALL, ""), (
        "with a namespace, viewers would delete that one only"
    )
    assert DELETE_ALL not in {m.action for m in others}


def test_markers_can_be_seen():
    for marker in markers(event())[1:]:
        assert marker.color.a == 1
        assert marker.pose.orientation.w == 1
        assert marker.pose.position.z > 0, "above the points and grids"
    _, outline, text = markers(event())
    assert outline.scale.x > 0
    assert text.scale.z > 0


def test_kinds_have_different_colours():
    colours = {(m.color.r, m.color.g, m.color.b) for kind in Kind for m in markers(event(kind=kind))[1:]}
    assert len(colours) == len(Kind)
