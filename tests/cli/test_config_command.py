from tests.cli.program import timemap
from timemap_cli.config import Settings, dump, load


def test_config_prints_the_settings_that_hold_by_default():
    ran = timemap("config")
    assert (ran.code, ran.err) == (0, "")
    assert ran.out == dump(Settings())


def test_config_prints_a_file_completed(tmp_path):
    path = tmp_path / "mine.yaml"
    path.write_text("map: {radius: 5}\n")
    ran = timemap("config", "--config", path)
    assert "  radius: 5.0 " in ran.out
    assert "  angle_bins: 360 " in ran.out


def test_what_config_prints_can_be_given_to_config(tmp_path):
    path = tmp_path / "paper.yaml"
    path.write_text(timemap("config", "--profile", "paper").out)
    assert load(path) == load(None, {"profile": "paper"})
    assert timemap("config", "--config", path).out == path.read_text()


def test_config_refuses_a_wrong_file_with_the_nearest_key(tmp_path):
    path = tmp_path / "mine.yaml"
    path.write_text("map: {raduis: 5}\n")
    ran = timemap("config", "--config", path)
    assert (ran.code, ran.out) == (2, "")
    assert ran.err == f"error: unknown setting map.raduis in {path}\n  try: map.radius\n"
