"""A suite: many checks in one file, each with its own recordings, settings, tolerances and baseline."""

from collections.abc import Mapping, Sequence
from concurrent.futures import Future, ProcessPoolExecutor
from concurrent.futures.process import BrokenProcessPool
from dataclasses import replace
from difflib import get_close_matches
from multiprocessing import get_context
from pathlib import Path
from typing import Any

from timemap_cli.checking import Check, Updated, checked, update, without_verdict
from timemap_cli.checks import tolerances
from timemap_cli.checks.verdict import CheckedCase
from timemap_cli.errors import TimemapError, UsageError, as_expected, shown
from timemap_cli.yaml_files import read_yaml

_KEYS = ("name", "logs", "result", "baseline", "config", "tolerances")
_LONGEST = 4096  # letters of a path
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
            raise UsageError(
                f"two checks of {path} have the name {shown(name)}", hint="name: gives each its own"
            )
    return checks


def run(checks: Sequence[Check], jobs: int) -> list[CheckedCase]:
    """Every check in the order of the list, `jobs` at a time; the outcome does not depend on their number.

    Whatever becomes of one, even if its process dies, the others get their verdicts.
    """
    jobs = min(jobs, len(checks))
    if jobs < 2:
        return [checked(one) for one in checks]
    with _pool(jobs) as pool:
        begun = [_begun(pool, one) for one in checks]
        first = [_ended(one, case) for one, case in zip(checks, begun, strict=True)]
    # The process that died took all that had not ended with it: each of those once more, in one of its own.
    return [case or _alone(one) for one, case in zip(checks, first, strict=True)]


def _begun(pool: ProcessPoolExecutor, one: Check) -> "Future[CheckedCase] | None":
    try:
        return pool.submit(checked, one)
    except BrokenProcessPool:
        return None


def _ended(one: Check, begun: "Future[CheckedCase] | None") -> CheckedCase | None:
    """How a check ended; None where its process, or one beside it, died."""
    try:
        return begun.result() if begun else None
    except BrokenProcessPool:
        return None
    except Exception as error:  # noqa: BLE001 - what cannot be handed over between processes
        return without_verdict(one, as_expected(error))


def _alone(one: Check) -> CheckedCase:
    with _pool(1) as pool:
        died = TimemapError("its process was ended from outside, for want of memory perhaps")
        return _ended(one, _begun(pool, one)) or without_verdict(one, died)


def _pool(jobs: int) -> ProcessPoolExecutor:
    # A fresh process each: one that was forked would hold this one's threads in whatever state they were.
    return ProcessPoolExecutor(jobs, mp_context=get_context("spawn"))


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
    anew = [replace(one, tolerances=overrides) for one in checks]
    jobs = min(jobs, len(anew))
    if jobs < 2:
        return [update(one) for one in anew]
    with _pool(jobs) as pool:
        return list(pool.map(update, anew))


def _check(
    row: Any, path: Path, place: str, shared: Mapping[str, float], overrides: Mapping[str, float], exact: bool
) -> Check:
    if not isinstance(row, Mapping):
        raise UsageError(f"{place} is no check", hint=_FORM)
    _known(row, _KEYS, place)
    sources = _sources(row, place)
    name = row.get("name", "")
    if not isinstance(name, str | int) or len(str(name)) > _LONGEST:
        raise UsageError(f"the name of {place} is no text", hint=_FORM)
    if not _is_path(row.get("baseline")):
        raise UsageError(f"{place} has no baseline", hint=_FORM)
    folder = path.parent
    config = row.get("config")
    if config is not None and not _is_path(config):
        raise UsageError(f"config in {place} is no file of settings", hint=_FORM)
    return Check(
        sources=tuple(folder / source for source in sources),
        baseline=folder / row["baseline"],
        name=str(row.get("name", Path(row["baseline"]).stem)),
        config=None if config is None else folder / config,
        tolerances={**shared, **_tolerances(row, place), **overrides},
        exact=exact,
    )


def _sources(row: Mapping[str, Any], place: str) -> list[str]:
    if ("logs" in row) == ("result" in row):
        raise UsageError(f"{place} needs logs or a result, one of the two", hint=_FORM)
    logs = [row["result"]] if "result" in row else row["logs"]
    sources = [logs] if isinstance(logs, str) else logs
    if not isinstance(sources, list) or not sources or not all(map(_is_path, sources)):
        raise UsageError(f"logs in {place} is no list of recordings", hint=_FORM)
    return sources


def _is_path(value: object) -> bool:
    """Whether a value may name a file: the system takes no path that is empty, endless or holds a NUL."""
    return isinstance(value, str) and 0 < len(value) <= _LONGEST and "\0" not in value


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
            near = get_close_matches(shown(key), names, n=1)
            raise UsageError(
                f"unknown key {shown(key)} in {place}", hint=near[0] if near else f"one of {', '.join(names)}"
            )
