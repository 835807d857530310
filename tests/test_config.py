import math
import subprocess
import sys
from dataclasses import fields, is_dataclass, replace

import pytest
from hypothesis import given
from hypothesis import strategies as st

from timemap_cli.config import (
    GateSettings,
    InputSettings,
    LevelSettings,
    MapSettings,
    Settings,
    dump,
    load,
    settings_hash,
)
from timemap_cli.errors import UsageError
from timemap_cli.spans import Span


def file_with(tmp_path, text):
    path = tmp_path / "settings.yaml"
    path.write_text(text, encoding="utf-8")
    return path


def refusal(overrides):
    with pytest.raises(UsageError) as caught:
        load(None, overrides)
    return caught.value


def test_the_defaults_are_those_that_served_best_on_real_recordings():
    settings = load(None)
    assert settings.map == MapSettings(angle_bins=360, range_bin=0.1, radius=10.0, node_spacing=1.0)
    assert [(level.name, level.window, str(level.half_life)) for level in settings.levels] == [
        ("short", 7, "5obs"),
        ("mid", 25, "20obs"),
        ("long", 100, "200obs"),
    ]
    assert settings.gate == GateSettings(
        min_travel=0.05,
        min_turn_deg=5.0,
        min_interval_s=0.15,
        max_contradiction=0.75,
        max_position_std=0.5,
        max_yaw_std_deg=20.0,
        max_jump=0.5,
    )
    assert settings.estimate.every == Span(30.0, "s")
    assert settings.input == InputSettings((), "map", "auto", "auto", 0.05)
    assert (settings.seed, settings.profile) == (0, "default")


def test_a_file_changes_only_what_it_names(tmp_path):
    path = file_with(tmp_path, "map: {radius: 8}\ngate: {min_interval: 500 s}\nestimate: {every: 30obs}\n")
    settings = load(path)
    assert settings.map == MapSettings(radius=8.0)
    assert settings.gate == GateSettings(min_interval_s=500.0)
    assert settings.estimate.every == Span(30.0, "obs")
    assert settings.levels == Settings().levels


def test_overrides_win_over_the_file(tmp_path):
    path = file_with(tmp_path, "input: {map_frame: odom, poses: tf}\nseed: 1\n")
    settings = load(path, {"input": {"map_frame": "/world"}, "seed": 2})
    assert settings.input == InputSettings(map_frame="world", poses="tf")
    assert settings.seed == 2


def test_an_empty_file_is_the_defaults(tmp_path):
    assert load(file_with(tmp_path, "# nothing\n")) == Settings()


def test_levels_of_a_file_replace_the_default_ones(tmp_path):
    path = file_with(tmp_path, "levels:\n- {name: day, window: 10, half_life: 12h}\n")
    assert load(path).levels == (LevelSettings("day", 10, Span(43200.0, "s")),)


@pytest.mark.parametrize(
    ("overrides", "unknown", "nearest"),
    [
        ({"map": {"raduis": 5}}, "map.raduis", "map.radius"),
        ({"radius": 5}, "radius", "map.radius"),
        ({"maps": {}}, "maps", "map"),
        ({"gate": {"min_travel_m": 1}}, "gate.min_travel_m", "gate.min_travel"),
        ({"gate": {"min_interval_s": 1}}, "gate.min_interval_s", "gate.min_interval"),
        ({"input": {"topic": []}}, "input.topic", "input.scan_topics"),
        (
            {"levels": [{"name": "a", "window": 5, "half_life": "9obs", "halflife": "8obs"}]},
            "levels[0].halflife",
            "levels[0].half_life",
        ),
    ],
)
def test_an_unknown_key_names_the_nearest_known_one(overrides, unknown, nearest):
    error = refusal(overrides)
    assert error.message == f"unknown setting {unknown} in the options"
    assert error.hint == nearest


def test_an_unknown_key_far_from_all_others_lists_those_of_its_place():
    assert (
        refusal({"gate": {"qqqq": 1}}).hint
        == "one of min_travel, min_turn_deg, min_interval, max_contradiction, max_position_std, max_yaw_std_deg, "
        "max_jump"
    )


def test_a_file_is_named_in_what_is_said_about_it(tmp_path):
    path = file_with(tmp_path, "map: {radius: 99}\n")
    with pytest.raises(UsageError) as caught:
        load(path)
    assert caught.value.message == f"map.radius is 99, outside 0.5 to 60 m (in {path})"


@pytest.mark.parametrize(
    ("section", "key", "low", "high", "unit"),
    [
        ("map", "angle_bins", 12, 3600, ""),
        ("map", "range_bin", 0.01, 1.0, " m"),
        ("map", "radius", 0.5, 60.0, " m"),
        ("map", "node_spacing", 0.1, 20.0, " m"),
        ("gate", "min_travel", 0.0, 100.0, " m"),
        ("gate", "min_turn_deg", 0.0, 180.0, " deg"),
        ("gate", "max_contradiction", 0.5, 1.0, ""),
        ("gate", "max_position_std", 0.0, 1000.0, " m"),
        ("gate", "max_yaw_std_deg", 0.0, 360.0, " deg"),
        ("gate", "max_jump", 0.0, 1000.0, " m"),
        ("input", "max_dropped", 0.0, 1.0, ""),
    ],
)
def test_a_number_is_taken_up_to_its_bounds_and_not_beyond(section, key, low, high, unit):
    for value in (low, high):
        assert getattr(getattr(load(None, {section: {key: value}}), section), key) == value
    for value in (low - 1, high + 1, math.nan, math.inf, 10**400):
        message = refusal({section: {key: value}}).message
        assert message.startswith(f"{section}.{key} is ")
        assert f"{low:g} to {high:g}{unit} (in the options)" in message
    for value in ("5", True, None, [5]):
        assert "number" in refusal({section: {key: value}}).message


def test_the_radius_fits_millimetres_in_16_bits():
    largest = load(None, {"map": {"radius": 60}}).map.radius
    assert largest * 1000 < 2**16 - 2


@pytest.mark.parametrize(
    ("overrides", "said"),
    [
        ({"map": {"angle_bins": 360.5}}, "map.angle_bins is 360.5, not a whole number (12 to 3600)"),
        ({"seed": -1}, "seed is -1, outside 0 to 4294967295"),
        (
            {"gate": {"min_interval": 0.2}},
            "gate.min_interval is 0.2, not a number with its unit, such as 0.5s",
        ),
        ({"gate": {"min_interval": "3obs"}}, "gate.min_interval is '3obs', outside 0 to 86400 s"),
        ({"gate": {"min_interval": "25h"}}, "gate.min_interval is '25h', outside 0 to 86400 s"),
        ({"estimate": {"every": "0s"}}, "estimate.every is '0s', outside 0.1 to 1000000 s or obs"),
        ({"estimate": {"every": 10}}, "estimate.every is 10, not a number with its unit"),
        ({"input": {"no_return": "free"}}, "input.no_return is 'free', not one of: auto, clear, ignore"),
        ({"input": {"no_return": True}}, "input.no_return is true, not one of: auto, clear, ignore"),
        ({"input": {"scan_topics": "/scan"}}, "input.scan_topics is '/scan', not a list of topics"),
        ({"input": {"scan_topics": [""]}}, "input.scan_topics is '', not a name"),
        ({"input": {"map_frame": ""}}, "input.map_frame is '', not a name"),
        ({"input": {"poses": "a\nb"}}, "input.poses is 'a b', not a name"),
        ({"profile": "papers"}, "profile is 'papers', not one of: default, paper"),
        ({"levels": []}, "levels in the options is not a list of levels"),
        ({"levels": {"name": "short"}}, "levels in the options is not a list of levels"),
        ({"levels": ["short"]}, "levels[0] in the options has no name"),
        ({"levels": [{"name": "a", "window": 7}]}, "levels[0] in the options has no half_life"),
        (
            {"levels": [{"name": "Day 1", "window": 7, "half_life": "9obs"}]},
            "levels[0].name is 'Day 1', not a name",
        ),
        (
            {"levels": [{"name": "a", "window": 0, "half_life": "9obs"}]},
            "levels[0].window is 0, outside 1 to 1000",
        ),
        ({"map": 5}, "map in the options holds no settings"),
    ],
)
def test_a_wrong_value_is_named_with_its_unit_and_range(overrides, said):
    assert refusal(overrides).message.startswith(said)


def test_a_zero_interval_needs_no_unit():
    assert load(None, {"gate": {"min_interval": 0}}).gate.min_interval_s == 0.0


@pytest.mark.parametrize(("window", "shortest"), [(7, 4.852), (25, 17.329), (100, 69.315)])
def test_a_half_life_below_window_times_ln_2_cannot_be_had(window, shortest):
    # One scan replaces at most one of N samples: (1 - 1/N)^t = 1/2 needs t of about N ln 2 scans.
    level = {"name": "a", "window": window, "half_life": f"{shortest + 0.001:.3f}obs"}
    assert load(None, {"levels": [level]}).levels[0].window == window
    error = refusal({"levels": [level | {"half_life": f"{shortest - 0.001:.3f}obs"}]})
    assert f"a window of {window} samples cannot have a half-life of" in error.message
    assert f"its shortest is {shortest:.1f}obs" in error.message
    assert "half_life: " in error.hint
    assert "window: " in error.hint


def test_what_the_hint_about_half_lives_proposes_is_accepted():
    error = refusal({"levels": [{"name": "a", "window": 50, "half_life": "20obs"}]})
    half_life, window = "35obs", 28
    assert error.hint == f"half_life: {half_life}, or window: {window}"
    load(None, {"levels": [{"name": "a", "window": 50, "half_life": half_life}]})
    load(None, {"levels": [{"name": "a", "window": window, "half_life": "20obs"}]})


def test_a_half_life_in_time_is_free_of_the_window():
    assert (
        load(None, {"levels": [{"name": "a", "window": 100, "half_life": "1s"}]}).levels[0].half_life.value
        == 1
    )


def test_levels_have_different_names_and_come_fastest_first():
    fast = {"name": "fast", "window": 7, "half_life": "5obs"}
    slow = {"name": "slow", "window": 7, "half_life": "50obs"}
    assert refusal({"levels": [fast, fast]}).message == "two levels have the name fast"
    error = refusal({"levels": [slow, fast]})
    assert error.message == "level fast (5obs) is faster than slow (50obs), which stands before it"
    assert error.hint == "list the levels fastest first"


def test_the_paper_profile_has_the_numbers_of_the_paper_no_gate_and_no_guard():
    settings = load(None, {"profile": "paper"})
    assert settings.map.angle_bins == 360
    assert settings.map.range_bin * 20 == pytest.approx(settings.map.radius) == 1.5
    assert settings.gate == GateSettings(0.0, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0)
    assert settings.profile == "paper"


def test_a_file_wins_over_the_numbers_of_the_profile(tmp_path):
    path = file_with(tmp_path, "profile: paper\nmap: {radius: 3}\n")
    assert load(path).map == MapSettings(radius=3.0, range_bin=0.075)
    assert load(path, {"profile": "default"}).gate == GateSettings()


def test_a_missing_settings_file_is_a_usage_error(tmp_path):
    with pytest.raises(UsageError, match=r"no settings file .*absent\.yaml") as caught:
        load(tmp_path / "absent.yaml")
    assert caught.value.hint == f"timemap config > {tmp_path}/absent.yaml"


@pytest.mark.parametrize(
    "text", ["map: {radius: [}", "a: 1\na: 2\n", "\x00", "a: !!python/object:os.system x\n"]
)
def test_what_is_not_yaml_is_said_in_one_line(tmp_path, text):
    path = file_with(tmp_path, text)
    with pytest.raises(UsageError, match="is not YAML") as caught:
        load(path)
    assert "\n" not in caught.value.message
    assert "unicode string" not in caught.value.message
    assert "https:" not in caught.value.message
    assert ">" not in caught.value.hint  # nobody is led to overwrite what they wrote


def test_what_is_not_yaml_is_told_with_its_line(tmp_path):
    path = file_with(tmp_path, "seed: 1\nmap: {radius: 3\ngate: {}\n")
    with pytest.raises(UsageError) as caught:
        load(path)
    assert caught.value.message == f"{path} is not YAML: line 3: expected ',' or '}}', but got ':'"


@pytest.mark.parametrize("text", ["just words\n", "- 1\n- 2\n"])
def test_a_file_without_settings_is_a_usage_error(tmp_path, text):
    with pytest.raises(UsageError, match="holds no settings"):
        load(file_with(tmp_path, text))


def test_a_folder_or_other_bytes_as_settings_file_are_usage_errors(tmp_path):
    with pytest.raises(UsageError, match=r"cannot read the settings file .*: is a directory"):
        load(tmp_path)
    path = tmp_path / "bytes.yaml"
    path.write_bytes(b"\xff\xfe\xfa")
    with pytest.raises(UsageError, match=r"cannot read the settings file .*: it is not a text"):
        load(path)


@pytest.mark.parametrize(("value", "shown"), [("null", "empty"), ("", "empty"), ("true", "true")])
def test_a_wrong_value_is_shown_as_the_file_has_it(tmp_path, value, shown):
    path = file_with(tmp_path, f"map:\n  radius: {value}\n")
    with pytest.raises(UsageError, match=f"map.radius is {shown}, not a number"):
        load(path)


def test_the_printed_settings_say_unit_and_meaning_of_every_value():
    lines = dump(Settings()).splitlines()
    assert "  radius: 10.0            # [0.5 to 60 m] how far a node looks; beyond is clear" in lines
    assert "  - {name: mid, window: 25, half_life: 20obs}" in lines
    assert all("#" in line for line in lines if not line.endswith(":") and "- {" not in line)
    assert max(map(len, lines)) <= 120


@pytest.mark.parametrize("profile", ["default", "paper"])
def test_the_printed_settings_read_back_to_the_same(tmp_path, profile):
    settings = load(None, {"profile": profile})
    assert load(file_with(tmp_path, dump(settings))) == settings


names = st.text(st.characters(exclude_categories=["Cs"]), min_size=1, max_size=12).filter(
    lambda text: text.isprintable() and text.strip()
)


level_names = st.from_regex(r"[a-z][a-z0-9_]*", fullmatch=True)


@st.composite
def any_settings(draw):
    settings = Settings(
        map=MapSettings(draw(st.integers(12, 3600)), draw(st.floats(0.01, 1)), draw(st.floats(0.5, 60))),
        levels=(LevelSettings(draw(level_names), 2, Span(draw(st.floats(0.5, 1e9)), "s")),),
        gate=GateSettings(
            draw(st.floats(0, 100)),
            draw(st.floats(0, 180)),
            draw(st.floats(0, 86400)),
            draw(st.floats(0.5, 1)),
        ),
        input=InputSettings(
            tuple(dict.fromkeys(draw(st.lists(names, max_size=3)))),
            draw(names.filter(lambda text: not text.startswith("/"))),
            draw(names),
            draw(st.sampled_from(["auto", "clear", "ignore"])),
            draw(st.floats(0, 1)),
        ),
        seed=draw(st.integers(0, 2**32 - 1)),
    )
    every = Span(draw(st.floats(0.1, 1e6)), draw(st.sampled_from(["s", "obs"])))
    return replace(settings, estimate=replace(settings.estimate, every=every))


@given(any_settings())
def test_any_settings_read_back_from_their_print(tmp_path_factory, settings):
    path = file_with(tmp_path_factory.mktemp("settings"), dump(settings))
    assert load(path) == settings


def test_the_hash_counts_values_and_not_layout(tmp_path):
    written = file_with(tmp_path, "levels:\n- {half_life: 300s, name: a, window: 7}\nmap:\n    radius: 10\n")
    other = tmp_path / "other.yaml"
    other.write_text("levels: [{name: a, window: 7, half_life: 5min}]  # the same\n")
    assert settings_hash(load(written)) == settings_hash(load(other))
    assert len(settings_hash(Settings())) == 64


@pytest.mark.parametrize("section", [field.name for field in fields(Settings)])
def test_every_section_counts_in_the_hash(section):
    other = {
        "map": MapSettings(radius=9.0),
        "levels": Settings().levels[:2],
        "gate": GateSettings(min_travel=0.1),
        "estimate": replace(Settings().estimate, every=Span(11.0, "s")),
        "input": InputSettings(map_frame="world"),
        "seed": 1,
        "profile": "paper",
    }[section]
    assert settings_hash(replace(Settings(), **{section: other})) != settings_hash(Settings())


def test_every_setting_declares_kind_and_meaning():
    def leaves(settings):
        for field in fields(settings):
            value = getattr(settings, field.name)
            if is_dataclass(value) and not isinstance(value, Span):
                yield from leaves(value)
            elif field.name != "levels":
                yield field

    assert all({"kind", "meaning"} <= set(field.metadata) for field in leaves(Settings()))


def test_settings_need_neither_numpy_nor_yaml():
    code = (
        "import sys\nfrom timemap_cli.config import dump, load\n"
        "dump(load(None))\nprint({'numpy', 'ruamel'} & set(sys.modules))"
    )
    ran = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert ran.stdout == "set()\n"
