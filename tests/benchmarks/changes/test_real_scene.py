"""Recordings of real robots, for which simulated ones stand in here."""

import pytest

from benchmarks.changes.recordings import make
from benchmarks.changes.scenes import real
from benchmarks.changes.scenes.real import Corridor, Quiet, expected, real_recordings
from benchmarks.changes.scenes.work import Work
from benchmarks.changes.truth import bounds_of
from benchmarks.changes.worlds.open_hall import LAYOUTS, hall

TABLE = """# two objects
kind,x_min,x_max,y_min,y_max
removed,1.0,1.5,2.0,2.25
removed,8.0,9.0,4.0,5.0
"""


def test_the_table_of_objects_is_read():
    first, second = expected(TABLE, 77)
    assert bounds_of(first.outline) == (1.0, 2.0, 1.5, 2.25)
    assert bounds_of(second.outline) == (8.0, 4.0, 9.0, 5.0)
    assert {(c.kind, c.episodes[0].since_ns, c.episodes[0].until_ns) for c in (first, second)} == {
        ("vanished", 77, None)
    }


def test_nothing_is_measured_without_recordings(tmp_path):
    (without,) = real_recordings(Work(tmp_path))
    assert "--data" in without
    (empty,) = real_recordings(Work(tmp_path, data=tmp_path))
    assert "holds none" in empty


@pytest.fixture(scope="module")
def data(tmp_path_factory):
    """Both runs of a hall, and the table of what is gone after the first."""
    folder = tmp_path_factory.mktemp("data")
    one = hall(LAYOUTS[0])
    make(folder, one.drives())
    gone = [t.bounds for t in one.things if t.until < 1e9]
    rows = "\n".join(f"removed,{x1},{x2},{y1},{y2}" for x1, y1, x2, y2 in gone)
    (folder / "gone.csv").write_text(f"kind,x_min,x_max,y_min,y_max\n{rows}\n")
    return folder


def test_quiet_recordings_and_a_corridor_are_measured(data, tmp_path, monkeypatch):
    monkeypatch.setattr(real, "WEAN", Corridor("corridor", ("run_1", "run_2"), "gone.csv"))
    monkeypatch.setattr(real, "QUIET", (Quiet("quiet", "run_1"), Quiet("not there", "run_3")))
    corridor, quiet = real_recordings(Work(tmp_path, data=data))
    assert "of 7 told" in corridor.splitlines()[2]
    assert quiet.splitlines()[0].startswith("quiet: ")
    assert quiet.splitlines()[2] == "  changes: 0 others"
