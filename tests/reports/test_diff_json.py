"""The comparison for programs."""

import json
from math import inf, nan

import numpy as np
import pytest

from tests.reports.differences import (
    APPEARED,
    COMPARED,
    MOVED,
    NEW,
    NODES,
    NOTHING_COMPARED,
    OLD,
    VANISHED,
    difference,
)
from timemap_cli.changes.difference import Change, Difference, Kind, Sector
from timemap_cli.reports.diff_json import diff_json

NO_POINTS = np.zeros((0, 2))


def document(told: Difference):
    def refuse(constant: str):
        raise AssertionError(f"{constant} is not JSON")

    return json.loads(diff_json(told, NODES, OLD, NEW), parse_constant=refuse)


def test_document_has_the_fields_that_programs_read():
    assert document(difference(VANISHED)) == {
        "schema": "timemap.diff/1",
        "from": {"result": "house.timemap.mcap", "level": "long", "stamp_ns": "1714564800000000000"},
        "to": {"result": "house.timemap.mcap", "level": "mid", "stamp_ns": "1714564800250000000"},
        "changes": [
            {
                "kind": "vanished",
                "x": 2.0,
                "y": -0.004,
                "bounds": [1.95, -0.3, 2.0, 0.3],
                "support": 0.8125,
                "moved_from": None,
                "sectors": [
                    {
                        "node": 0,
                        "start_deg": 351.0,
                        "stop_deg": 9.0,
                        "range_from_m": 2.0,
                        "range_to_m": "clear",
                    },
                    {"node": 1, "start_deg": 40.0, "stop_deg": 70.0, "range_from_m": 1.25, "range_to_m": 4.5},
                ],
            }
        ],
        "nodes": [
            {"id": 0, "x": 0.0, "y": 0.0, "compared_bins": 350, "changed_bins": 31},
            {"id": 1, "x": 1.5, "y": 0.0, "compared_bins": 300, "changed_bins": 30},
            {"id": 2, "x": 3.0, "y": 0.25, "compared_bins": 120, "changed_bins": 6},
        ],
        "summary": {
            "changes": 1,
            "small": 0,
            "appeared": 0,
            "vanished": 1,
            "moved": 0,
            "compared_nodes": 3,
            "silent_nodes": 0,
            "compared_bins": 770,
            "changed_bins": 67,
            "angle_bins": 360,
        },
    }


def test_changes_keep_their_order_and_kinds():
    told = document(difference(MOVED, VANISHED, APPEARED))
    assert [change["kind"] for change in told["changes"]] == ["moved", "vanished", "appeared"]
    assert told["changes"][0]["moved_from"] == [4.4, 6.8]


def test_bearings_are_degrees_whatever_the_resolution():
    fine = Difference((APPEARED,), COMPARED, (), 1440)
    (sector,) = document(fine)["changes"][0]["sectors"]
    assert (sector["start_deg"], sector["stop_deg"]) == (42.5, 44.0)


def test_sector_up_to_the_end_of_the_circle_stops_at_360():
    change = Change(
        Kind.VANISHED, 1.0, 0.0, (0.9, 0.0, 1.1, 0.0), 0.5, (Sector(0, 350, 360, 2.0, 3.0),), NO_POINTS
    )
    assert document(difference(change))["changes"][0]["sectors"][0]["stop_deg"] == 360.0


def test_nothing_compared_is_a_document_too():
    told = document(NOTHING_COMPARED)
    assert (told["changes"], told["nodes"]) == ([], [])
    assert (told["summary"]["silent_nodes"], told["summary"]["angle_bins"]) == (2, None)


def test_not_a_number_is_refused_rather_than_written():
    broken = Change(Kind.VANISHED, nan, 0.0, (0.0, 0.0, 0.0, inf), 0.5, (), NO_POINTS)
    with pytest.raises(ValueError, match="not JSON compliant"):
        diff_json(difference(broken), NODES, OLD, NEW)
