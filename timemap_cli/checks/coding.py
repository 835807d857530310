"""The ranges of one ring as a line of text: `231 ab=A 412 ?12 *3`, so that a difference of two is local.

A number is a range in centimetres; behind it each letter is one angle bin more, by 1 to 26 centimetres farther (`a` to
`z`) or nearer (`A` to `Z`) than the bin before, or as far (`=`). `?12` are twelve unknown bins, `*3` three clear ones.
"""

import re
from collections.abc import Sequence
from itertools import groupby

import numpy as np
import numpy.typing as npt

Floats = npt.NDArray[np.float64]

PER_METRE = 100  # a centimetre is what a scanner measures to
_UNKNOWN, _CLEAR = -1, -2
_RUNS = {_UNKNOWN: "?", _CLEAR: "*"}
_MOST = 26
_WORD = re.compile(
    r"(?P<letters>[a-zA-Z=]+)|(?P<number>[0-9]{1,7})|\?(?P<unknown>[0-9]{1,7})|\*(?P<clear>[0-9]{1,7})"
)


def encoded(ranges: Floats) -> str:
    """The line of a ring (angle_bins,) [m]; +inf is clear, NaN unknown."""
    words: list[str] = []
    before: int | None = None  # the range that letters count from
    for is_run, group in groupby(_centimetres(ranges), key=lambda code: min(0, code)):
        codes = list(group)
        if is_run:
            words.append(f"{_RUNS[is_run]}{len(codes)}")
            before = None
            continue
        for code in codes:
            if before is None or abs(code - before) > _MOST:
                words.append(str(code))
            elif words[-1][-1].isdigit():
                words.append(_letter(code - before))
            else:
                words[-1] += _letter(code - before)
            before = code
    return " ".join(words)


def decoded(line: str, angle_bins: int) -> Floats:
    """The ring (angle_bins,) [m] of a line. Raises ValueError for anything that `encoded` does not write."""
    codes: list[int] = []
    for word in line.split():
        match = _WORD.fullmatch(word)
        if match is None:
            raise ValueError(f"'{word[:20]}' is no part of a ring")
        codes += _codes(match, codes)
        if len(codes) > 10 * angle_bins:  # a run that is this wrong need not fill the memory
            break
    if len(codes) != angle_bins:
        raise ValueError(f"{len(codes)} angle bins instead of {angle_bins}")
    numbers = np.array(codes, np.float64)
    return np.select([numbers == _UNKNOWN, numbers == _CLEAR], [np.nan, np.inf], numbers / PER_METRE)


def rounded(ranges: Floats) -> Floats:
    """Ranges [m] as a line keeps them: to the centimetre."""
    return np.asarray(np.rint(ranges * PER_METRE) / PER_METRE)


def _centimetres(ranges: Floats) -> Sequence[int]:
    whole = np.where(np.isfinite(ranges), ranges, 0.0) * PER_METRE
    codes = np.select([np.isnan(ranges), np.isposinf(ranges)], [_UNKNOWN, _CLEAR], np.rint(whole))
    found: list[int] = codes.astype(np.int64).tolist()
    return found


def _codes(match: "re.Match[str]", before: Sequence[int]) -> list[int]:
    if match["number"]:
        return [int(match["number"])]
    for name, code in (("unknown", _UNKNOWN), ("clear", _CLEAR)):
        if match[name]:
            return [code] * int(match[name])
    if not before or before[-1] < 0:
        raise ValueError(f"'{match['letters'][:20]}' has no range to count from")
    steps = [_step(letter) for letter in match["letters"]]
    found: list[int] = (before[-1] + np.cumsum(steps)).tolist()
    if min(found) < 0:
        raise ValueError(f"'{match['letters'][:20]}' counts below zero")
    return found


def _letter(step: int) -> str:
    if step == 0:
        return "="
    return chr(ord("a") + step - 1) if step > 0 else chr(ord("A") - step - 1)


def _step(letter: str) -> int:
    if letter == "=":
        return 0
    return ord(letter) - ord("a") + 1 if letter.islower() else ord("A") - ord(letter) - 1
