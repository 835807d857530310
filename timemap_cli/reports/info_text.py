"""What is in recordings, as a text of one screen."""

from collections.abc import Iterator, Sequence
from math import degrees

from timemap_cli.logs.beams import BeamCounts
from timemap_cli.logs.inspect import Inspection, LogInfo, PoseInfo
from timemap_cli.logs.irregularities import duration
from timemap_cli.logs.missing_returns import MissingReturns
from timemap_cli.logs.pose_quality import PoseReport
from timemap_cli.logs.scan_statistics import ScanTopic
from timemap_cli.times import format_time

Row = tuple[str, str]  # a word in the left column, and what is said about it


def info_text(inspection: Inspection) -> str:
    """A paragraph for each recording and one on what a replay would use. Ends without a newline."""
    paragraphs = [_log(log) for log in inspection.logs]
    paragraphs.append(_outlook(inspection))
    return "\n\n".join("\n".join(lines) for lines in paragraphs)


def _log(log: LogInfo) -> list[str]:
    rows = [*(row for scan in log.scans for row in _scan(scan)), *map(_pose, log.poses)]
    if log.other_topics:
        rows.append(("", f"and {log.other_topics} other {_plural('topic', log.other_topics)}"))
    rows += _list("problem", log.problems)
    return [f"{log.path}: {log.format}, {_extent(log)}", *_columns(rows)]


def _extent(log: LogInfo) -> str:
    """How long it is and when it was recorded, by log times."""
    if log.end_ns == 0:
        return "no message that can be read"
    return f"{duration((log.end_ns - log.start_ns) / 1e9)} from {_to_the_millisecond(log.start_ns)}"


def _to_the_millisecond(stamp_ns: int) -> str:
    return format_time(stamp_ns // 10**6 * 10**6)


def _scan(scan: ScanTopic) -> Iterator[Row]:
    if scan.count == 0:
        yield scan.topic, "no scan that can be read"
        return
    rate = f" at {scan.rate_hz:.3g} Hz" if scan.rate_hz else ""
    yield scan.topic, f"{scan.count} {_plural('scan', scan.count)}{rate} in '{scan.frame_id}'"
    yield (
        "",
        f"{scan.n_beams} beams over {scan.fov_deg:.0f} deg, {scan.range_min_m:.3g} to {scan.range_max_m:.3g} m",
    )
    yield "", _kinds(scan.beams)
    for text in scan.found:
        yield "", text
    yield "", _posed(scan.with_pose, scan.count)
    for text in _pose_quality(scan.pose_report):
        yield "", text


def _pose_quality(found: PoseReport | None) -> Iterator[str]:
    """How uncertain the poses are, where they jump, and what a replay would set aside for it."""
    if found is None:
        return
    if found.position_std is not None and found.yaw_std is not None:
        yield (
            f"poses uncertain by up to {found.position_std:.2g} m and {degrees(found.yaw_std):.2g} deg "
            f"(one standard deviation, {found.covariances})"
        )
    if found.jumps:
        largest = f"{found.largest_jump:.2g} m at {_to_the_millisecond(found.largest_jump_ns)}"
        times = "once, by" if found.jumps == 1 else f"{found.jumps} times, by up to"
        yield f"poses jump {times} {largest}"
    reasons = ", ".join(f"{reason} {count}" for reason, count in found.set_aside.items() if count)
    if reasons:
        count = sum(found.set_aside.values())
        yield f"{count} {_plural('scan', count)} would be set aside: {reasons}"


def _kinds(beams: BeamCounts) -> str:
    kinds = (
        (beams.hit, "hit"),
        (beams.no_return, "no return"),
        (beams.invalid, "invalid"),
        (beams.too_close, "too close"),
    )
    return "beams: " + ", ".join(f"{_percent(count, beams.total)} {name}" for count, name in kinds if count)


def _pose(pose: PoseInfo) -> Row:
    name = pose.msgtype.rsplit("/", 1)[-1]
    if pose.frame_id is None:
        return pose.topic, f"{pose.count} {name}"
    of = f" of '{pose.child_frame_id}'" if pose.child_frame_id else ""
    return pose.topic, f"{pose.count} {name}{of} in '{pose.frame_id}'"


def _outlook(inspection: Inspection) -> list[str]:
    """What a replay would use, or why it would not start."""
    selection, trouble = inspection.selection, inspection.trouble
    if selection is None:
        message = trouble.message if trouble else "nothing to replay"
        hints = (trouble.hint or "").splitlines() if trouble else []
        return [f"A replay would stop: {_one_line(message)}", *(f"  try: {hint}" for hint in hints)]
    poses = " and ".join(" > ".join(chain) for chain in inspection.chains)
    rows = [
        ("scans", ", ".join(selection.scan_topics)),
        ("map frame", selection.map_frame),
        ("poses", f"{selection.pose} ({poses})" if poses else selection.pose),
    ]
    if inspection.span_ns is not None:
        begin, end = map(_to_the_millisecond, inspection.span_ns)
        rows.append(("stamps", f"{begin} to {end}, the time that --start and --end mean"))
    rows += _no_returns(inspection)
    rows += _list("warning", selection.warnings)
    rows += _list("problem", inspection.problems)
    return ["A replay would use", *_columns(rows)]


def _no_returns(inspection: Inspection) -> Iterator[Row]:
    """What a missing return counts as; for several logs or topics one row for each of them."""
    if not inspection.missing_returns:
        yield "no return", f"{'free space' if inspection.no_return == 'clear' else 'no evidence'}, as set"
    several_topics = len({topic for _, topic in inspection.missing_returns}) > 1
    for (index, topic), found in inspection.missing_returns.items():
        of = [inspection.logs[index].path] if len(inspection.logs) > 1 else []
        of += [topic] if several_topics else []
        are_clear = inspection.missing_are_clear[index, topic]
        yield "no return", ": ".join([*of, _no_return(found, are_clear)])


def _no_return(found: MissingReturns, are_clear: bool) -> str:
    word = "free space" if are_clear else "no evidence"
    if found.beams == 0:
        return "there is none"
    if found.contradicted is None:
        return f"{word}; {found.beams} in the sample, too few to test"
    share = f"{100 * found.contradicted:.0f} % of those sampled pass through something solid"
    if found.are_clear != are_clear:
        return f"{word}: {share}, but others of the recordings before it"
    return f"{word}: {share}" if are_clear else f"{word}: {share} (glass, mirrors, black surfaces)"


def _list(word: str, sentences: Sequence[str]) -> list[Row]:
    return [
        (_plural(word, len(sentences)) if index == 0 else "", text) for index, text in enumerate(sentences)
    ]


def _columns(rows: Sequence[Row]) -> list[str]:
    shown = [(_one_line(word), _one_line(text)) for word, text in rows]
    width = max((len(word) for word, _ in shown), default=0)
    return [f"  {word.ljust(width)}  {text}" for word, text in shown]


def _one_line(text: str) -> str:
    """Names of topics and frames may hold line feeds: what follows one must not look like our own words."""
    return text.replace("\n", "\\n")


def _posed(part: int, whole: int) -> str:
    if whole == 1:
        return "it has a pose" if part else "it has no pose"
    return f"all {whole} scans have a pose" if part == whole else f"{part} of {whole} scans have a pose"


def _percent(part: int, whole: int) -> str:
    share = 100 * part / whole
    if share < 0.1:
        return "< 0.1 %"
    return "> 99.9 %" if 99.9 < share < 100 else f"{share:.3g} %"


def _plural(noun: str, count: int) -> str:
    return noun if count == 1 else f"{noun}s"
