"""What the numbers of one scanner's beams mean: hits, missing returns, and readings that say nothing.

REP 117 gives `+inf` to a missing return, NaN to an invalid reading and `-inf` to an object too close. Drivers
older than it, and many younger ones, use numbers instead: the message's range_max, range_max + 1, the largest
number of the scanner's protocol, or 0. And a message's range_max cannot be trusted: some drivers set it to
the largest range of each scan. So the codes are settled per recording and topic, from a sample of its scans.
"""

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Self

import numpy as np
from numpy.typing import NDArray

from timemap_cli.logs.batches import Float32s, ScanBatch

# SCIP scanners (Hokuyo) put error codes 0..19 where millimetres belong.
LEAST_RANGE = 0.02  # [m]
# Numbers of scanner protocols that stand for "no echo", in cm (SICK LMS 2xx, 0x1ff1..0x1fff) or mm.
PROTOCOL_CODES = ((81.765, 81.915), (65.525, 65.5355))  # [m] closed
SAME = 1e-5  # share by which a number may differ from a code and still be it
VARIES = "range_max differs from scan to scan"
WALL_SPAN = 0.35  # [rad] a flat wall does not give one number over so wide an angle


@dataclass(frozen=True, slots=True)
class BeamCounts:
    """How many beams were of which kind."""

    hit: int = 0
    no_return: int = 0
    invalid: int = 0  # NaN, 0, negative
    too_close: int = 0  # -inf, or below the scanner's least range

    @property
    def total(self) -> int:
        """All beams."""
        return self.hit + self.no_return + self.invalid + self.too_close

    def __add__(self, other: "BeamCounts") -> "BeamCounts":
        return BeamCounts(
            self.hit + other.hit,
            self.no_return + other.no_return,
            self.invalid + other.invalid,
            self.too_close + other.too_close,
        )


@dataclass(frozen=True, slots=True)
class Beams:
    """How the beams of one scan topic of one recording are to be read."""

    range_min: float  # [m] what is nearer says nothing
    no_return_from: float  # [m] numbers from here on stand for a missing return; inf: none do
    no_return_at_range_max: bool  # the message's own range_max stands for a missing return, whatever it is
    clear_range: float  # [m] how far a missing return frees space, where it does
    missing_is_clear: bool  # False: a missing return is no evidence
    found: tuple[str, ...]  # what was found, in words

    def resolve(self, ranges: Float32s, range_max: Float32s) -> Float32s:
        """Ranges with one meaning each: finite a hit, `+inf` a missing return that frees, NaN no evidence.

        `ranges` (n, beams) and `range_max` (n,) as recorded, [m]; a new array (n, beams) is returned.
        """
        resolved = np.array(ranges, dtype=np.float32)
        missing = self._missing(resolved, range_max)
        np.copyto(resolved, np.float32(np.nan), where=~(resolved >= np.float32(self.range_min)))
        np.copyto(resolved, np.float32(np.inf if self.missing_is_clear else np.nan), where=missing)
        return resolved

    def count(self, ranges: Float32s, range_max: Float32s) -> BeamCounts:
        """How many of the beams, as recorded, are of which kind."""
        missing = int(np.count_nonzero(self._missing(ranges, range_max)))
        far_enough = int(np.count_nonzero(ranges >= np.float32(self.range_min)))
        near = int(np.count_nonzero((ranges > 0) & (ranges < np.float32(self.range_min))))
        near += int(np.count_nonzero(np.isneginf(ranges)))
        return BeamCounts(
            hit=far_enough - missing,
            no_return=missing,
            invalid=ranges.size - far_enough - near,
            too_close=near,
        )

    def ignoring_missing(self) -> Self:
        """The same beams, a missing return being no evidence."""
        return replace(self, missing_is_clear=False)

    def _missing(self, ranges: Float32s, range_max: Float32s) -> NDArray[np.bool_]:
        missing = ranges >= np.float32(self.no_return_from)
        if self.no_return_at_range_max:
            missing |= ranges >= range_max[:, None]
        return missing


def settle(sample: Sequence[ScanBatch]) -> Beams:
    """Settle what the beams of one topic mean from a sample of its scans (at least one).

    Missing returns free space in the outcome; whether they really do is for `missing_returns` to say.
    """
    range_max = np.concatenate([batch.range_max for batch in sample])
    range_min = _range_min(sample)
    nominal, words = _nominal(range_max)
    codes = _codes(sample, range_min, nominal)
    threshold = codes[-1].begin if codes else float("inf")
    at_range_max = False
    if words == VARIES:
        at_range_max = _repeats_range_max(sample, threshold)
        if at_range_max:
            words = f"{VARIES} and stands for a missing return"
        elif _is_largest_of_scan(sample, threshold):
            words = "range_max is the largest range of each scan: not used"
    beams = Beams(range_min, threshold, at_range_max, 0.0, True, ())
    clear_range, doubt = _clear_range(beams, sample, nominal)
    found = (*_codes_in_words(sample, codes), *_low_codes_in_words(sample, range_min), words, doubt)
    return replace(beams, clear_range=clear_range, found=tuple(text for text in found if text))


def _range_min(sample: Sequence[ScanBatch]) -> float:
    """Least range [m] that is a measurement."""
    stated = [batch.layout.range_min for batch in sample if np.isfinite(batch.layout.range_min)]
    return max(float(np.median(stated)) if stated else 0.0, LEAST_RANGE)


def _nominal(range_max: Float32s) -> tuple[float | None, str]:
    """The scanner's range [m] as its messages state it, where they state one; and what is odd about it."""
    values = np.unique(range_max[np.isfinite(range_max) & (range_max > 0)])
    if values.size == 0:
        return None, "range_max is not given"
    if values.size <= max(1, min(3, range_max.size // 20)):
        return float(values[0]), "" if values.size == 1 else f"range_max takes {values.size} values"
    return None, VARIES


def _is_largest_of_scan(sample: Sequence[ScanBatch], threshold: float) -> bool:
    """Whether range_max is the largest range of each scan; what `threshold` [m] and more stands for is none."""
    equal, scans = 0, 0
    for batch in sample:
        finite = np.where(batch.ranges < np.float32(threshold), batch.ranges, np.float32(0))
        equal += int(np.count_nonzero(np.isclose(finite.max(axis=1, initial=0), batch.range_max, rtol=SAME)))
        scans += len(batch.range_max)
    return equal >= 0.9 * scans


def _repeats_range_max(sample: Sequence[ScanBatch], threshold: float) -> bool:
    """Whether a range_max that differs from scan to scan is shared by more beams than a far corner has.

    Beams that show a code, from `threshold` [m] on, are missing anyway.
    """
    equal = 0
    for batch in sample:
        reached = (batch.ranges >= batch.range_max[:, None]) & (batch.ranges < np.float32(threshold))
        equal += int(np.count_nonzero(reached))
    scans = sum(len(batch.range_max) for batch in sample)
    beams = sum(batch.ranges.size for batch in sample)
    return equal > 3 * scans and equal > 0.01 * beams


@dataclass(frozen=True, slots=True)
class _Code:
    """Numbers that stand for a missing return, and why they are taken for it."""

    begin: float  # [m] the least of them
    why: str


def _codes(sample: Sequence[ScanBatch], range_min: float, nominal: float | None) -> list[_Code]:
    """The codes for a missing return, largest first."""
    flat = np.concatenate([batch.ranges.ravel() for batch in sample])
    values, counts = np.unique(flat[np.isfinite(flat) & (flat >= np.float32(range_min))], return_counts=True)
    found: list[_Code] = []
    # A scanner may have several codes; the largest number of all is one of them, or there is none.
    while values.size:
        begin = _begin_of_code(float(values[-1]))
        block = values >= np.float32(begin)
        near = counts[(values > 0.95 * begin) & ~block]
        why = _why_a_code(sample, float(values[-1]), int(counts[block].sum()), near, flat.size, nominal)
        if why is None:
            break
        found.append(_Code(begin, why))
        values, counts = values[~block], counts[~block]
    return found


def _begin_of_code(value: float) -> float:
    """The least number [m] that means the same as a code."""
    for low, high in PROTOCOL_CODES:
        if low <= value <= high:
            return low
    return value * (1 - SAME)


def _why_a_code(
    sample: Sequence[ScanBatch],
    value: float,
    count: int,
    near: NDArray[np.int64],
    total: int,
    nominal: float | None,
) -> str | None:
    """Why the largest number is a code; None if it is a far wall. `near` counts the numbers just below it."""
    if any(low <= value <= high for low, high in PROTOCOL_CODES):
        return "the scanner's own code"
    share = f"in {100 * count / total:.2g} % of the beams"
    if nominal is not None and value >= nominal * (1 - SAME):
        at = "range_max" if value <= nominal * (1 + SAME) else f"beyond range_max {nominal:g} m"
        return f"{at}, {share}" if count >= max(3, 5 * int(near.max(initial=0))) else None
    enough = count >= max(20, 0.003 * total, 10 * int(near.sum()))
    span = _span(sample, value)
    return f"{share}, over {np.degrees(span):.0f} deg of one scan" if enough and span > WALL_SPAN else None


def _span(sample: Sequence[ScanBatch], value: float) -> float:
    """Angle [rad] between the outermost beams that show a number in the same scan, at the widest."""
    widest = 0.0
    for batch in sample:
        equal = batch.ranges >= np.float32(value * (1 - SAME))
        first = equal.argmax(axis=1)
        last = equal.shape[1] - 1 - equal[:, ::-1].argmax(axis=1)
        beams = np.where(equal.any(axis=1), last - first, 0)
        widest = max(widest, float(beams.max(initial=0)) * abs(batch.layout.angle_increment))
    return widest


def _clear_range(beams: Beams, sample: Sequence[ScanBatch], nominal: float | None) -> tuple[float, str]:
    """How far [m] the scanner sees, and what is odd about it."""
    resolved = np.concatenate([beams.resolve(batch.ranges, batch.range_max).ravel() for batch in sample])
    hits = resolved[np.isfinite(resolved)]
    if nominal is None:
        return (float(np.quantile(hits, 0.999)) if hits.size else 0.0), ""
    beyond = float(np.mean(hits > nominal * (1 + SAME))) if hits.size else 0.0
    doubt = f"{100 * beyond:.2g} % of the hits lie beyond range_max {nominal:g} m" if beyond > 0.001 else ""
    if beyond > 0.05:
        return float(np.quantile(hits, 0.999)), doubt
    return nominal, doubt


def _codes_in_words(sample: Sequence[ScanBatch], codes: Sequence[_Code]) -> tuple[str, ...]:
    """The numbers that were taken for missing returns, and why; of those of one code the frequent ones."""
    flat = np.concatenate([batch.ranges.ravel() for batch in sample])
    found = []
    above = np.float32(np.inf)
    for code in codes:
        begin = np.float32(code.begin)
        values, counts = np.unique(flat[(flat >= begin) & (flat < above)], return_counts=True)
        numbers = ", ".join(f"{value:g}" for value in values[counts >= 0.01 * counts.sum()])
        found.append(f"no return: {numbers} m ({code.why})")
        above = begin
    infinite = ("no return: inf (REP 117)",) if np.isposinf(flat).any() else ()
    return (*infinite, *found)


def _low_codes_in_words(sample: Sequence[ScanBatch], range_min: float) -> tuple[str, ...]:
    """Numbers that say nothing and that many beams show: what stands for an invalid reading, and blind beams.

    A beam is blind where the robot's own body stands in its way, or where an error code stands for metres.
    """
    flat = np.concatenate([batch.ranges.ravel() for batch in sample])
    low = flat[~(flat >= np.float32(range_min)) & ~np.isneginf(flat)]
    values, counts = np.unique(low, return_counts=True)
    often = counts >= 0.01 * flat.size
    shares = [
        (f"{value:g}", 100 * count / flat.size)
        for value, count in zip(values[often], counts[often], strict=True)
    ]
    invalid = [name for name, _ in shares if name in ("nan", "0")]
    blind = [f"{name} m in {share:.0f} %" for name, share in shares if name not in ("nan", "0")]
    found = [f"invalid: {' and '.join(invalid)} (no evidence)"] if invalid else []
    return (*found, *([f"blind: {', '.join(blind)} of the beams"] if blind else []))
