"""A recording or a result against its baseline: replaying where that is due, comparing, and writing baselines."""

from collections.abc import Callable, Iterator, Mapping, Sequence
from contextlib import ExitStack, contextmanager
from dataclasses import dataclass, field
from functools import partial
from pathlib import Path
from tempfile import TemporaryDirectory

from timemap_cli import assembly
from timemap_cli.checks import baseline_file
from timemap_cli.checks.baseline_file import Baseline
from timemap_cli.checks.compare import compare
from timemap_cli.checks.snapshot import Snapshot
from timemap_cli.checks.taken import taken
from timemap_cli.checks.tolerances import defaults
from timemap_cli.checks.verdict import CheckedCase, Verdict
from timemap_cli.config import Settings, load
from timemap_cli.errors import TimemapError, UsageError, as_expected
from timemap_cli.logs.recordings import open_recordings
from timemap_cli.logs.survey import survey
from timemap_cli.model.nodes import Node
from timemap_cli.replay import Progress, ReplaySummary, replay
from timemap_cli.results.atomic_file import AtomicFile
from timemap_cli.results.container import is_result
from timemap_cli.results.reader import ResultReader
from timemap_cli.stages import Observing

Look = Callable[[ResultReader, Snapshot, Verdict], None]


@dataclass(frozen=True, slots=True)
class Check:
    """What is to be checked against what."""

    sources: tuple[Path, ...]  # one result, or recordings
    baseline: Path
    name: str
    config: Path | None = None  # settings of the replay
    output: Path | None = None  # where the result of the replay stays; None: nowhere
    force: bool = False  # whether that may be replaced
    tolerances: Mapping[str, float] = field(default_factory=dict)  # above those of the baseline
    exact: bool = False


@dataclass(frozen=True, slots=True)
class Updated:
    """A baseline that was written."""

    path: Path
    snapshot: Snapshot
    was: Verdict | None  # the new one against the old one; None: there was none, or none to compare with
    lost: bool
    warnings: tuple[str, ...]


def check(
    one: Check,
    progress: Progress | None = None,
    look: Look | None = None,
) -> CheckedCase:
    """Compare with the baseline; recordings are replayed with the baseline's nodes, as these came then.

    `look` is called with the result, what was expected and the verdict, while the result is there.

    Raises UsageError where there is no baseline or nothing can be compared, and what a replay raises.
    """
    baseline = baseline_file.read(one.baseline)
    with _result(one, baseline.expected, progress) as (result, summary), ResultReader(result) as reader:
        verdict = compare(
            baseline.expected,
            taken(reader),
            {**defaults(), **baseline.tolerances, **one.tolerances},
            name=one.name,
            baseline=str(one.baseline),
            exact=one.exact,
        )
        if look is not None:
            look(reader, baseline.expected, verdict)
    lost, warnings = _trouble(summary)
    return CheckedCase(one.name, str(one.baseline), verdict, lost=lost, warnings=warnings)


def update(one: Check, progress: Progress | None = None) -> Updated:
    """Write the baseline anew, in place of an older one; its tolerances and its nodes stay.

    `tolerances` of the check are kept in the file. Raises what `check` raises, and UsageError where something
    else than a baseline stands there.
    """
    old = baseline_file.read(one.baseline) if one.baseline.exists() else None
    with (
        _result(one, old.expected if old else None, progress) as (result, summary),
        ResultReader(result) as reader,
    ):
        found = taken(reader)
    tolerances = {**(old.tolerances if old else {}), **one.tolerances}
    with AtomicFile(
        one.baseline, force=True, may_replace=baseline_file.is_baseline, replaced="a baseline"
    ) as file:
        file.write(baseline_file.dump(Baseline(found, tolerances)).encode())
        file.commit()
    return Updated(one.baseline, found, _against(old, found, one), *_trouble(summary))


def checked(one: Check, progress: Progress | None = None, look: Look | None = None) -> CheckedCase:
    """The same as `check`; what goes wrong, whatever it is, becomes a case without a verdict."""
    try:
        return check(one, progress, look)
    except Exception as error:  # noqa: BLE001 - the other checks of a suite, and their report, do not suffer from it
        return without_verdict(one, as_expected(error))


def without_verdict(one: Check, error: TimemapError) -> CheckedCase:
    """A check that came to no verdict."""
    return CheckedCase(one.name, str(one.baseline), None, error)


def _against(old: Baseline | None, found: Snapshot, one: Check) -> Verdict | None:
    if old is None:
        return None
    try:
        return compare(
            old.expected,
            found,
            {**defaults(), **old.tolerances},
            name=one.name,
            baseline=str(one.baseline),
            exact=True,
        )
    except UsageError:
        return None


@contextmanager
def _result(
    one: Check, expected: Snapshot | None, progress: Progress | None
) -> Iterator[tuple[Path, ReplaySummary | None]]:
    """The result that is checked: itself, or what a replay of the recordings makes for the while."""
    results = [source for source in one.sources if is_result(source)]
    if results and len(one.sources) > 1:
        raise UsageError(
            f"{results[0]} is a result: it is checked alone",
            hint=f"timemap check {results[0]} --baseline {one.baseline}",
        )
    if results:
        yield results[0], None
        return
    with TemporaryDirectory(prefix="timemap-check-") as folder:
        yield from _replayed(one, expected, Path(folder), progress)


def _replayed(
    one: Check, expected: Snapshot | None, folder: Path, progress: Progress | None
) -> Iterator[tuple[Path, ReplaySummary]]:
    settings = load(one.config)
    output = one.output or folder / "checked.timemap.mcap"
    replaying = partial(replay, one.sources, output, settings, force=one.force, progress=progress)
    if expected is not None and expected.laid:
        yield output, replaying(likely=expected.nodes)
        return
    given = folder / "nodes"
    nodes = expected.nodes if expected else _laid(one.sources, settings)
    given.write_text("".join(f"{node.x}, {node.y}\n" for node in nodes), encoding="utf-8")
    try:
        summary = replaying(nodes=given)
    except UsageError as error:
        if str(given) not in error.message:
            raise
        raise UsageError(
            f"nothing can be compared with {one.baseline}: no scan comes near one of its nodes",
            hint=f"timemap info {one.sources[0]}",
        ) from error
    yield output, summary


def _laid(logs: Sequence[Path], settings: Settings) -> Sequence[Node]:
    """The nodes that a replay of the recordings would make, without learning anything."""
    with ExitStack() as stack:
        recordings = [stack.enter_context(recording) for recording in open_recordings(logs)]
        observing = Observing(recordings, survey(recordings, settings), assembly.observer(settings, ()))
        for _ in observing.steps(None, None):
            pass
        return tuple(observing.nodes)


def _trouble(summary: ReplaySummary | None) -> tuple[bool, tuple[str, ...]]:
    return (summary.data_lost, summary.warnings) if summary else (False, ())
