import sys

import numpy as np
import pytest

from tests.cli.program import timemap
from tests.cli.result_files import written

WHITE, UNKNOWN = (255, 255, 255), (199, 199, 199)
APPEARED = (0, 158, 115)
SHORT, MID, LONG = (230, 159, 0), (86, 180, 233), (34, 34, 34)


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """A folder with r.timemap.mcap: a round room, in which short and mid have learnt a box."""
    monkeypatch.chdir(tmp_path)
    written(tmp_path / "r.timemap.mcap")
    return tmp_path


@pytest.fixture
def image():
    return pytest.importorskip("matplotlib.image")


def colours(image, path):
    """How many pixels of the picture have a colour, by that colour."""
    pixels = np.rint(image.imread(path)[..., :3] * 255).astype(int).reshape(-1, 3)
    found, counts = np.unique(pixels, axis=0, return_counts=True)
    return dict(zip(map(tuple, found.tolist()), counts.tolist(), strict=True))


def test_the_slowest_level_is_drawn_with_free_space_white_and_unknown_grey(folder, image):
    ran = timemap("plot", "r.timemap.mcap")
    assert (ran.code, ran.out, ran.err) == (0, "r.png\n", "")
    told = colours(image, folder / "r.png")
    # Outside a circle in its square lie 1 - pi / 4 = 21 % of it; the frame round the square is white, too.
    assert 0.15 < told[UNKNOWN] / (told[UNKNOWN] + told[WHITE]) < 0.22
    assert APPEARED not in told


def test_surfaces_are_the_darker_the_better_supported(folder, image):
    from tests.cli.result_files import NODE, room
    from timemap_cli.reports.pictures import level_picture

    estimate = room("mid", 1, box=False)
    darkest = []
    for support in (0.1, 0.9):
        estimate.support[:] = support
        (folder / "p.png").write_bytes(level_picture("", [NODE], {0: estimate}, 10.0))
        middle = image.imread(folder / "p.png")[100:-100, 100:-100, :3]  # without words and axes
        darkest.append(float(middle.max(axis=2).min()))
    assert darkest[0] > darkest[1] + 0.2


def test_of_two_levels_what_differs_is_drawn_on_top(folder, image):
    assert timemap("plot", "r.timemap.mcap", "--level", "mid", "long", "-o", "two.png").code == 0
    assert colours(image, folder / "two.png")[APPEARED] > 100


def test_two_levels_that_agree_show_no_change(folder, image):
    assert timemap("plot", "r.timemap.mcap", "--level", "mid", "short", "-o", "two.png").code == 0
    assert APPEARED not in colours(image, folder / "two.png")


def test_a_node_is_drawn_with_all_levels(folder, image):
    assert timemap("plot", "r.timemap.mcap", "--node", "0", "-o", "node.png").code == 0
    told = colours(image, folder / "node.png")
    assert min(told[SHORT], told[MID], told[LONG]) > 100


def test_the_same_result_gives_the_same_picture(folder, image):
    for name in ("one.png", "two.png"):
        timemap("plot", "-o", name)
    assert (folder / "one.png").read_bytes() == (folder / "two.png").read_bytes()


@pytest.mark.parametrize(
    ("args", "said"),
    [
        ("--level long mid --level short", "3 levels given: long, mid, short"),
        ("--level slow", "has no level 'slow', only short, mid, long"),
        ("--level long long", "cannot differ from itself"),
        ("--node 1", "r.timemap.mcap has no node 1, only 0 to 0"),
        ("--node 0 --level long", "a node is drawn with all its levels"),
        ("--node -1", "--node"),
    ],
)
def test_what_cannot_be_drawn_is_one_error_with_something_to_try(folder, args, said):
    ran = timemap("plot", "r.timemap.mcap", *args.split())
    assert (ran.code, ran.out) == (2, "")
    assert said in ran.err.splitlines()[0]
    assert "\n  try: " in ran.err
    assert sorted(path.name for path in folder.iterdir()) == ["r.timemap.mcap"]


def test_what_is_proposed_for_a_wrong_level_can_be_drawn(folder):
    ran = timemap("plot", "r.timemap.mcap", "--level", "slow")
    assert ran.err.splitlines()[1:] == ["  try: timemap plot r.timemap.mcap --level long"]


def test_an_existing_picture_is_replaced_only_by_force(folder, image):
    assert timemap("plot", "-o", "p.png").code == 0
    assert timemap("plot", "-o", "p.png").err.splitlines()[1] == "error: p.png exists already"
    assert timemap("plot", "-o", "p.png", "--force").code == 0


def test_force_replaces_nothing_but_a_picture(folder):
    (folder / "mine.png").write_bytes(b"mine")
    ran = timemap("plot", "r.timemap.mcap", "-o", "mine.png", "--force")
    assert ran.code == 2
    assert "mine.png exists and is not a PNG picture: it is not replaced" in ran.err
    assert (folder / "mine.png").read_bytes() == b"mine"


@pytest.mark.parametrize("args", [(), ("--node", "0")])
def test_without_matplotlib_there_is_one_error_and_no_file(folder, monkeypatch, args):
    monkeypatch.setitem(sys.modules, "matplotlib.figure", None)  # as if it were not there
    ran = timemap("plot", "r.timemap.mcap", *args)
    assert (ran.code, ran.out) == (2, "")
    assert ran.err == (
        "error: a picture needs matplotlib, which is not installed\n  try: pip install 'timemap-cli[plot]'\n"
    )
    assert sorted(path.name for path in folder.iterdir()) == ["r.timemap.mcap"]
