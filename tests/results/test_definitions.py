import pytest
from rosbags.typesys import Stores, get_types_from_msg, get_typestore

from timemap_cli.model.status import Status
from timemap_cli.results import definitions

STANDARD = [
    definitions.LASER_SCAN,
    definitions.POINT_CLOUD,
    definitions.OCCUPANCY_GRID,
    definitions.TF_MESSAGE,
]


def typestore(msgtype):
    store = get_typestore(Stores.EMPTY)
    store.register(get_types_from_msg(definitions.definition(msgtype), msgtype))
    return store


@pytest.mark.parametrize("msgtype", STANDARD)
def test_standard_types_have_the_type_hash_of_ros_2_humble(msgtype):
    assert typestore(msgtype).hash_rihs01(msgtype) == get_typestore(Stores.ROS2_HUMBLE).hash_rihs01(msgtype)


def test_point_field_has_its_constants():
    constants = get_typestore(Stores.ROS2_HUMBLE).fielddefs["sensor_msgs/msg/PointField"][0]
    assert typestore(definitions.POINT_CLOUD).fielddefs["sensor_msgs/msg/PointField"][0] == constants


def test_status_begins_with_the_fields_that_its_first_readers_know():
    names = [name for name, _ in typestore(definitions.STATUS).fielddefs[definitions.STATUS][1]]
    assert names == ["header", "samples", "plausibility", "status", "last_seen", "known"]


def test_status_names_the_codes_of_the_model():
    constants = typestore(definitions.STATUS).fielddefs[definitions.STATUS][0]
    assert {name: value for name, _, value in constants} == {s.name: s.value for s in Status}


@pytest.mark.parametrize("msgtype", [*STANDARD, definitions.STATUS])
def test_every_type_within_is_defined_once(msgtype):
    lines = definitions.definition(msgtype).splitlines()
    headings = [line for line in lines if line.startswith("MSG: ")]
    assert "MSG: std_msgs/Header" in headings
    assert len(headings) == len(set(headings))


def test_a_type_that_no_result_holds_is_an_error():
    with pytest.raises(KeyError):
        definitions.definition("std_msgs/msg/String")
