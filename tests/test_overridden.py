"""Numbers of a profile that do not hold."""

from timemap_cli.config import Settings, dump, load
from timemap_cli.overridden import overridden


def test_a_profile_alone_overrides_nothing():
    assert overridden(load(None)) == []
    assert overridden(load(None, {"profile": "paper", "seed": 3})) == []


def test_default_numbers_in_a_file_override_those_of_the_paper(tmp_path):
    path = tmp_path / "settings.yaml"
    path.write_text(dump(Settings()).replace("profile: default", ""))
    assert overridden(load(path, {"profile": "paper"})) == [
        "map.range_bin 0.1 instead of 0.075",
        "map.radius 10.0 instead of 1.5",
        "gate.min_travel 0.05 instead of 0.0",
        "gate.min_turn_deg 5.0 instead of 0.0",
        "gate.min_interval 0.15s instead of 0s",
        "gate.max_contradiction 0.75 instead of 1.0",
        "gate.max_position_std 0.5 instead of 0.0",
        "gate.max_yaw_std_deg 20.0 instead of 0.0",
        "gate.max_jump 0.5 instead of 0.0",
    ]


def test_other_settings_than_those_of_the_profile_are_free(tmp_path):
    path = tmp_path / "settings.yaml"
    path.write_text("profile: paper\nmap: {radius: 3, node_spacing: 0.5}\n")
    assert overridden(load(path)) == ["map.radius 3.0 instead of 1.5"]
