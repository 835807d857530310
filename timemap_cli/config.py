"""Every setting with its unit, default and range; reading them from YAML and printing them as YAML."""

import dataclasses
import hashlib
import json
import math
from collections.abc import Mapping
from dataclasses import dataclass
from difflib import get_close_matches
from itertools import pairwise
from pathlib import Path
from typing import Any

from timemap_cli.errors import UsageError, shown
from timemap_cli.setting_kinds import Frame, Kind, Number, OneOf, Seconds, SpanOf, Text, Topics
from timemap_cli.spans import Span
from timemap_cli.yaml_files import parsed_yaml, read_yaml

HalfLife = Span
Period = Span

PROFILES = ("default", "paper")


def setting(default: Any, kind: Kind, meaning: str, *, key: str | None = None) -> Any:
    """Declare a setting: its default, what it may be, what it means, and its YAML key if not its own name."""
    metadata = {"kind": kind, "meaning": meaning, "key": key}
    if default is dataclasses.MISSING:
        return dataclasses.field(metadata=metadata)
    return dataclasses.field(default=default, metadata=metadata)


@dataclass(frozen=True, slots=True)
class MapSettings:
    """The nodes and what each of them divides its surroundings into."""

    angle_bins: int = setting(360, Number(12, 3600, whole=True), "equal sectors of the circle around a node")
    range_bin: float = setting(
        0.1, Number(0.01, 1.0, "m"), "ranges within half of this are one surface; grows beyond 1.6 m"
    )
    # Ranges are remembered as millimetres in 16 bits, two of which are taken by clear and unknown.
    radius: float = setting(10.0, Number(0.5, 60.0, "m"), "how far a node looks; beyond is clear")
    node_spacing: float = setting(
        1.0, Number(0.1, 20.0, "m"), "a scan farther than this from all nodes makes one"
    )


@dataclass(frozen=True, slots=True)
class LevelSettings:
    """One time scale of memory."""

    name: str = setting(dataclasses.MISSING, Text(r"[a-z][a-z0-9_]*"), "name of the level")
    window: int = setting(dataclasses.MISSING, Number(1, 1000, "samples", whole=True), "remembered ranges")
    half_life: HalfLife = setting(
        dataclasses.MISSING, SpanOf(0.5, 1e9, ("obs", "s")), "until half is replaced"
    )


@dataclass(frozen=True, slots=True)
class GateSettings:
    """When a slower level takes a scan: moved or turned enough, and time has passed; and what no level takes."""

    min_travel: float = setting(0.05, Number(0.0, 100.0, "m"), "moved at least so far, or")
    min_turn_deg: float = setting(5.0, Number(0.0, 180.0, "deg"), "turned at least so far; and")
    # Below a 5 Hz scanner's period: at 0.2 s its jitter would let every other scan fail.
    min_interval_s: float = setting(0.15, Seconds(0.0, 86400.0), "this time has passed", key="min_interval")
    # Poses off by half a metre and more reach it, furniture that was moved does not.
    max_contradiction: float = setting(
        0.75, Number(0.5, 1.0), "a scan that contradicts so much of a place is of a lost robot; 1: off"
    )
    # amcl starts from 0.5 m and 15 deg, and is far below that once it tracks.
    max_position_std: float = setting(
        0.5, Number(0.0, 1000.0, "m"), "a scan whose pose is less certain is not learnt; 0: off"
    )
    max_yaw_std_deg: float = setting(20.0, Number(0.0, 360.0, "deg"), "as max_position_std, of its yaw")
    # Corrections of a localiser that tracks stay below 0.2 m.
    max_jump: float = setting(
        0.5, Number(0.0, 1000.0, "m"), "scans within a larger jump of the pose are not learnt; 0: off"
    )


@dataclass(frozen=True, slots=True)
class EstimateSettings:
    """When a node that changed is estimated and written."""

    every: Period = setting(
        Span(30.0, "s"),
        SpanOf(0.1, 1e6, ("s", "obs")),
        "how often nodes that changed are estimated",
    )


@dataclass(frozen=True, slots=True)
class InputSettings:
    """What is read from the recordings."""

    scan_topics: tuple[str, ...] = setting((), Topics(), "none: the only one there is")
    map_frame: str = setting("map", Frame(), "frame in which the nodes stand")
    poses: str = setting("auto", Text(), "auto, tf, or the topic that holds the robot's pose")
    no_return: str = setting(
        "auto", OneOf(("auto", "clear", "ignore")), "a missing return is: tested, free space, or no evidence"
    )
    max_dropped: float = setting(
        0.05, Number(0.0, 1.0), "share of scans that may be lost before the exit code is 3"
    )


DEFAULT_LEVELS = (
    LevelSettings("short", 7, Span(5.0, "obs")),
    LevelSettings("mid", 25, Span(20.0, "obs")),
    LevelSettings("long", 100, Span(200.0, "obs")),
)


@dataclass(frozen=True, slots=True)
class Settings:
    """All settings of a replay. Levels are listed fastest first."""

    map: MapSettings = MapSettings()
    levels: tuple[LevelSettings, ...] = DEFAULT_LEVELS
    gate: GateSettings = GateSettings()
    estimate: EstimateSettings = EstimateSettings()
    input: InputSettings = InputSettings()
    seed: int = setting(0, Number(0, 2**32 - 1, whole=True), "the same seed gives the same bytes")
    profile: str = setting("default", OneOf(PROFILES), "paper: the method and the numbers of the paper")


def load(
    path: Path | None, overrides: Mapping[str, Any] | None = None, base: Settings | None = None
) -> Settings:
    """Settings from the defaults, a YAML file and overrides; what comes later wins.

    `overrides` has the shape of the file: `{"input": {"map_frame": "world"}}`. `profile` chooses the defaults
    below both, unless a `base` takes their place. UsageError names the setting and, for an unknown key, the
    nearest known one.
    """
    layers = [(str(path), read_yaml(path))] if path is not None else []
    layers.append(("the options", dict(overrides or {})))
    return _layered(layers, base)


def loads(text: str, place: str) -> Settings:
    """Settings from the text of a YAML file, as `dump` writes it; `place` is what errors call it."""
    return _layered([(place, parsed_yaml(text, place))], None)


def _layered(layers: list[tuple[str, Mapping[str, Any]]], base: Settings | None) -> Settings:
    settings = base or _defaults(_profile(layers))
    for place, values in layers:
        settings = _updated(settings, values, place)
    _check_levels(settings.levels)
    return settings


def dump(settings: Settings) -> str:
    """The settings as YAML with comments; `load` reads it back to the same settings."""
    lines = ["# timemap settings: unit, range and meaning stand beside each value."]
    for field in dataclasses.fields(settings):
        value = getattr(settings, field.name)
        if field.name == "levels":
            lines += _level_lines(value)
        elif dataclasses.is_dataclass(value) and not isinstance(value, type):
            lines += [f"{field.name}:", *_setting_lines(value, "  ")]
    lines += _setting_lines(settings, "")
    return "\n".join(lines) + "\n"


def settings_hash(settings: Settings) -> str:
    """SHA-256, in hexadecimal, over the values of all settings; comments and layout do not count."""
    values = json.dumps(_plain(settings), sort_keys=True, ensure_ascii=True, separators=(",", ":"))
    return hashlib.sha256(values.encode()).hexdigest()


def _profile(layers: list[tuple[str, Mapping[str, Any]]]) -> str:
    chosen = "default"
    for place, values in layers:
        if "profile" in values:
            chosen = _read(OneOf(PROFILES), values["profile"], "profile", place)
    return chosen


def _defaults(profile: str) -> Settings:
    """The defaults of a profile; `paper` has the numbers of the paper's experiments, no gate and no guard."""
    if profile == "default":
        return Settings()
    return Settings(
        map=MapSettings(angle_bins=360, range_bin=0.075, radius=1.5),
        gate=GateSettings(
            min_travel=0.0,
            min_turn_deg=0.0,
            min_interval_s=0.0,
            max_contradiction=1.0,
            max_position_std=0.0,
            max_yaw_std_deg=0.0,
            max_jump=0.0,
        ),
        profile=profile,
    )


def _updated(target: Any, values: Any, place: str, path: str = "") -> Any:
    """`target`, a dataclass of settings, with the values of a nested mapping in their place."""
    if not isinstance(values, Mapping):
        raise UsageError(f"{path.rstrip('.')} in {place} holds no settings", hint="timemap config")
    fields = {field.metadata.get("key") or field.name: field for field in dataclasses.fields(target)}
    changes: dict[str, Any] = {}
    for key, value in values.items():
        if key not in fields:
            raise _unknown(shown(key), list(fields), path, place)
        field = fields[key]
        old = getattr(target, field.name, None)
        if key == "levels":
            changes[field.name] = _levels(value, place)
        elif "kind" in field.metadata:
            changes[field.name] = _read(field.metadata["kind"], value, f"{path}{key}", place)
        else:
            changes[field.name] = _updated(old, value, place, f"{path}{key}.")
    return dataclasses.replace(target, **changes)


def _levels(values: object, place: str) -> tuple[LevelSettings, ...]:
    if not isinstance(values, list | tuple) or not values:
        raise UsageError(f"levels in {place} is not a list of levels", hint="timemap config")
    return tuple(_level(value, f"levels[{index}].", place) for index, value in enumerate(values))


def _level(values: object, path: str, place: str) -> LevelSettings:
    names = [field.name for field in dataclasses.fields(LevelSettings)]
    missing = [name for name in names if not isinstance(values, Mapping) or name not in values]
    if missing:
        raise UsageError(
            f"{path.rstrip('.')} in {place} has no {missing[0]}",
            hint="a level is written {name: short, window: 7, half_life: 5obs}",
        )
    blank = LevelSettings("blank", 2, Span(1.0, "s"))
    level: LevelSettings = _updated(blank, values, place, path)
    return level


def _check_levels(levels: tuple[LevelSettings, ...]) -> None:
    """UsageError for equal names, a half-life that the window cannot have, or a wrong order."""
    for index, level in enumerate(levels):
        if level.name in [other.name for other in levels[:index]]:
            raise UsageError(f"two levels have the name {level.name}")
        # One scan can replace one sample of the window at most.
        shortest = level.window * math.log(2)
        if level.half_life.unit == "obs" and level.half_life.value < shortest:
            raise UsageError(
                f"level {level.name}: a window of {level.window} samples cannot have a half-life of "
                f"{level.half_life}, its shortest is {shortest:.1f}obs",
                hint=f"half_life: {math.ceil(shortest)}obs, or "
                f"window: {max(1, math.floor(level.half_life.value / math.log(2)))}",
            )
    for faster, slower in pairwise(levels):
        comparable = faster.half_life.unit == slower.half_life.unit
        if comparable and faster.half_life.value > slower.half_life.value:
            raise UsageError(
                f"level {slower.name} ({slower.half_life}) is faster than {faster.name} "
                f"({faster.half_life}), which stands before it",
                hint="list the levels fastest first",
            )


def _read(kind: Kind, value: object, name: str, place: str) -> Any:
    try:
        return kind.read(value)
    except ValueError as error:
        raise UsageError(f"{name} {error} (in {place})") from error


def _unknown(key: str, known: list[str], path: str, place: str) -> UsageError:
    here = {name: f"{path}{name}" for name in known}
    candidates = _paths_by_key(Settings()) | here
    near = get_close_matches(key, here, n=1, cutoff=0.5) or get_close_matches(
        key, candidates, n=1, cutoff=0.5
    )
    hint = candidates[near[0]] if near else f"one of {', '.join(known)}"
    return UsageError(f"unknown setting {path}{key} in {place}", hint=hint)


def _paths_by_key(settings: Any, path: str = "") -> dict[str, str]:
    """Last key -> whole path, for all settings: `{"radius": "map.radius", ...}`."""
    paths: dict[str, str] = {}
    for field in dataclasses.fields(settings):
        key = field.metadata.get("key") or field.name
        paths[key] = f"{path}{key}"
        value = getattr(settings, field.name)
        if dataclasses.is_dataclass(value) and "kind" not in field.metadata:
            paths |= _paths_by_key(value, f"{path}{key}.")
    return paths


def _setting_lines(settings: Any, indent: str) -> list[str]:
    """One line for each setting of a dataclass, with its range and meaning as comment."""
    lines = []
    for field in dataclasses.fields(settings):
        if "kind" in field.metadata:
            kind = field.metadata["kind"]
            key = field.metadata["key"] or field.name
            entry = f"{indent}{key}: {kind.show(getattr(settings, field.name))}"
            allowed = f"[{kind.allowed}] " if kind.allowed else ""
            lines.append(f"{entry:<25} # {allowed}{field.metadata['meaning']}")
    return lines


def _level_lines(levels: tuple[LevelSettings, ...]) -> list[str]:
    fields = dataclasses.fields(LevelSettings)
    lines = [
        "levels:  # fastest first; half_life: 50obs (scans of the node that passed the gate), 30s, 10min, 12h"
    ]
    for level in levels:
        values = [
            f"{field.name}: {field.metadata['kind'].show(getattr(level, field.name))}" for field in fields
        ]
        lines.append(f"  - {{{', '.join(values)}}}")
    return lines


def _plain(value: Any) -> Any:
    """The settings as JSON has them."""
    if isinstance(value, Span):
        return str(value)
    if dataclasses.is_dataclass(value):
        return {field.name: _plain(getattr(value, field.name)) for field in dataclasses.fields(value)}
    return [_plain(item) for item in value] if isinstance(value, tuple) else value
