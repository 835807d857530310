"""A suite: many checks in one file, each with its own recordings, settings, tolerances and baseline."""

from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import replace
from difflib import get_close_matches
from multiprocessing import get_context
from pathlib import Path
from typing import Any, TypeVar

from timemap_cli.checking import Check, Updated, checked, update
from timemap_cli.checks import tolerances
from timemap_cli.checks.verdict import CheckedCase
from timemap_cli.errors import UsageError
from timemap_cli.yaml_files import read_yaml

T = TypeVar("T")

_KEYS = ("name", "logs", "result", "baseline", "config", "tolerances")
_FORM = "checks: [{name: monday, logs: [monday.mcap], baseline: monday.yaml}]"


def read_suite(path: Path, overrides: Mapping[str, float], *, exact: bool) -> list[Check]:
    """The checks of a suite file; its paths count from its folder, `overrides` go above all its tolerances.

    UsageError where it is missing, no suite, names something unknown, or names two checks alike.
    """
    values = read_yaml(path, "suite", _FORM)
    _known(values, ("checks", "tolerances"), str(path))
    rows = values.get("checks")
    if not isinstance(rows, list) or not rows:
        raise UsageError(f"{path} lists no checks", hint=_FORM)
    shared = _tolerances(values, str(path))
    checks = [
        _check(row, path, f"checks[{i}] of {path}", shared, overrides, exact) for i, row in enumerate(rows)
    ]
    names = [one.name for one in checks]
    for name in names:
        if names.count(name) > 1:
            raise UsageError(f"two checks of {path} have the name {name}", hint="name: gives each its own")
    return checks


def run(checks: Sequence[Check], jobs: int) -> list[CheckedCase]:
    """Every check in the order of the list, `jobs` at a time; the outcome does not depend on their number."""
    return _mapped(checked, checks, jobs)


def update_all(checks: Sequence[Check], overrides: Mapping[str, float], jobs: int) -> list[Updated]:
    """Write the baseline of every check anew; `overrides` are kept in each, the suite's tolerances stay in the suite.

    UsageError, and nothing is written, where two checks have one baseline: the last would win.
    """
    places = [one.baseline.resolve() for one in checks]
    for one, place in zip(checks, places, strict=True):
        if places.count(place) > 1:
            raise UsageError(
                f"{one.baseline} is the baseline of more than one check",
                hint="--update-baseline on one of them alone",
            )
    return _mapped(update, [replace(one, tolerances=overrides) for one in checks], jobs)


def _mapped(work: Callable[[Check], T], checks: Sequence[Check], jobs: int) -> list[T]:
    jobs = min(jobs, len(checks))
    if jobs < 2:
        return [work(one) for one in checks]
    # A fresh process each: one that was forked would hold this one's threads in whatever state they were.
    with ProcessPoolExecutor(jobs, mp_context=get_context("spawn")) as pool:
        return list(pool.map(work, checks))


def _check(
    row: Any, path: Path, place: str, shared: Mapping[str, float], overrides: Mapping[str, float], exact: bool
) -> Check:
    if not isinstance(row, Mapping):
        raise UsageError(f"{place} is no check", hint=_FORM)
    _known(row, _KEYS, place)
    sources = _sources(row, place)
    if not isinstance(row.get("name", ""), str | int):
        raise UsageError(f"the name of {place} is no text", hint=_FORM)
    if not isinstance(row.get("baseline"), str) or not row["baseline"]:
        raise UsageError(f"{place} has no baseline", hint=_FORM)
    folder = path.parent
    config = row.get("config")
    return Check(
        sources=tuple(folder / source for source in sources),
        baseline=folder / row["baseline"],
        name=str(row.get("name", Path(row["baseline"]).stem)),
        config=None if config is None else folder / str(config),
        tolerances={**shared, **_tolerances(row, place), **overrides},
        exact=exact,
    )


def _sources(row: Mapping[str, Any], place: str) -> list[str]:
    if ("logs" in row) == ("result" in row):
        raise UsageError(f"{place} needs logs or a result, one of the two", hint=_FORM)
    logs = [row["result"]] if "result" in row else row["logs"]
    sources = [logs] if isinstance(logs, str) else logs
    if not isinstance(sources, list) or not sources or not all(isinstance(one, str) for one in sources):
        raise UsageError(f"logs in {place} is no list of recordings", hint=_FORM)
    return sources


def _tolerances(values: Mapping[str, Any], place: str) -> dict[str, float]:
    given = values.get("tolerances") or {}
    if not isinstance(given, Mapping):
        raise UsageError(
            f"tolerances in {place} are no names with values", hint="tolerances: {ranges.moved: 0.02}"
        )
    return tolerances.checked(given, place)


def _known(values: Mapping[str, Any], names: Sequence[str], place: str) -> None:
    for key in values:
        if key not in names:
            near = get_close_matches(str(key), names, n=1)
            raise UsageError(
                f"unknown key {key} in {place}", hint=near[0] if near else f"one of {', '.join(names)}"
            )
