"""A state from somebody who wishes us ill: one clear error, or an answer."""

from contextlib import suppress

import numpy as np
import pytest

from tests.results.rewriting import rewritten
from tests.test_replay import standing_log
from timemap_cli.config import load
from timemap_cli.errors import TimemapError
from timemap_cli.replay import replay
from timemap_cli.results.channels import STATE_TOPIC
from timemap_cli.results.reader import ResultReader
from timemap_cli.results.state_messages import Part, StatePart, pack_state, unpack_state

SETTINGS = load(None)
DAY_NS = 86_400_000_000_000
WRONG = {
    "gone": None,
    "a text": lambda _: "x",
    "a number": lambda _: -1,
    "shorter": lambda value: value[:-1] if getattr(value, "ndim", 0) else 2**70,
    "large": lambda value: np.full_like(value, 200) if isinstance(value, np.ndarray) else [[9]] * 9,
}


@pytest.fixture(scope="module")
def days(tmp_path_factory):
    folder = tmp_path_factory.mktemp("days")
    first, second = (standing_log(folder / f"{n}.mcap", start_ns=n * DAY_NS, n_scans=300) for n in (1, 2))
    return replay([first], folder / "one.timemap.mcap", SETTINGS).result, second


def names_of(result, part):
    with ResultReader(result) as reader:
        return next(sorted(kept.state) for kept in reader.state() if kept.part is part)


def with_wrong(part, name, wrong):
    def change(message):
        kept = unpack_state(message)
        if kept.part is not part:
            return message
        others = {key: value for key, value in kept.state.items() if key != name}
        state = others if wrong is None else others | {name: wrong(kept.state[name])}
        return pack_state(StatePart(part, kept.node, state), 0, "map")

    return change


@pytest.mark.parametrize("part", list(Part))
@pytest.mark.parametrize("kind", WRONG)
def test_a_state_that_does_not_fit_is_told_as_damage_or_does_no_harm(days, tmp_path, monkeypatch, part, kind):
    result, log = days
    monkeypatch.setattr("timemap_cli.second_process._usable_processors", lambda: {0})
    # Every fourth, so that all five kinds together meet every name.
    for name in names_of(result, part)[list(WRONG).index(kind) % 4 :: 4]:
        change = {STATE_TOPIC: with_wrong(part, name, WRONG[kind])}
        wrong = rewritten(result, tmp_path / "wrong.mcap", messages=change)
        with suppress(TimemapError):
            replay([log], tmp_path / "two.timemap.mcap", SETTINGS, resume=wrong, force=True)


def test_a_state_that_does_not_fit_is_called_damage(days, tmp_path):
    result, log = days
    change = {STATE_TOPIC: with_wrong(Part.NODE, "map.long.samples", WRONG["a text"])}
    wrong = rewritten(result, tmp_path / "wrong.mcap", messages=change)
    with pytest.raises(TimemapError, match=r"wrong\.mcap is damaged: what it kept to go on from"):
        replay([log], tmp_path / "two.timemap.mcap", SETTINGS, resume=wrong)
    assert not (tmp_path / "two.timemap.mcap").exists()
