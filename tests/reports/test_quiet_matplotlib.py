import logging
import os
from contextlib import nullcontext
from pathlib import Path

import pytest

from timemap_cli.reports.quiet_matplotlib import quiet_matplotlib

NAMES = ("HOME", "XDG_CACHE_HOME", "XDG_CONFIG_HOME", "MPLCONFIGDIR", "MPL_IGNORE_SYSTEM_FONTS")


@pytest.fixture(autouse=True)
def caller(monkeypatch):
    """A program that draws with matplotlib itself, with settings of its own."""
    mpl = pytest.importorskip("matplotlib")
    monkeypatch.setitem(mpl.rcParams, "figure.facecolor", "red")
    monkeypatch.setenv("HOME", "/home/somebody")
    monkeypatch.delenv("XDG_CACHE_HOME", raising=False)
    monkeypatch.delenv("MPLCONFIGDIR", raising=False)
    return mpl


def surroundings(mpl):
    return {name: os.environ.get(name) for name in NAMES}, mpl.rcParams["figure.facecolor"]


@pytest.mark.parametrize("trouble", [None, KeyError])
def test_the_callers_surroundings_come_back(caller, trouble):
    before = surroundings(caller)
    with pytest.raises(KeyError) if trouble else nullcontext(), quiet_matplotlib():
        assert surroundings(caller)[1] == "white"
        assert os.environ["HOME"] != "/home/somebody"
        if trouble:
            raise trouble
    assert surroundings(caller) == before


def test_it_says_nothing_within_and_all_afterwards(caplog):
    logger = logging.getLogger("matplotlib.font_manager")
    with quiet_matplotlib():
        logger.warning("within")
    logger.warning("afterwards")
    assert [record.message for record in caplog.records] == ["afterwards"]


def test_its_folder_is_gone_afterwards():
    with quiet_matplotlib():
        folder = Path(os.environ["MPLCONFIGDIR"])
        assert folder.is_dir()
    assert not folder.exists()


def test_a_folder_that_the_user_names_is_used(monkeypatch, tmp_path):
    monkeypatch.setenv("MPLCONFIGDIR", str(tmp_path))
    with quiet_matplotlib():
        assert os.environ["MPLCONFIGDIR"] == str(tmp_path)
