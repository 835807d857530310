"""Real recordings: flicker, half objects and accuracy of the default, beside the median per angle bin."""

import os
import sys
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import pairwise
from pathlib import Path

import numpy as np
import numpy.typing as npt

from benchmarks.paper.definitions import DEFINITIONS
from benchmarks.paper.metrics import runs
from benchmarks.paper.recorded import Followed, followed, recorded
from benchmarks.paper.section import Scale, Section, Table
from benchmarks.paper.words import number, percent, share
from timemap_cli.assembly import levels
from timemap_cli.config import Settings
from timemap_cli.model.virtual_scan import CLEAR, UNSEEN, Bools, Ranges

_FOLDER = "TIMEMAP_SHARED_DATA"  # environment variable: where the recordings are
_RECORDINGS = {
    "Intel Research Lab": ("intel/intel.mcap",),
    "Wean Hall, three runs": ("wean/wean_run1.mcap", "wean/wean_run3.mcap", "wean/wean_run4.mcap"),
}
_COMPARED = ("ours", "vote without pairs", "median per angle bin")

_STEP, _STEP_SHARE = 200, 0.03  # [mm] and of the nearer range: what counts as a difference, as in `diff`
_BACK_WITHIN = 10  # scans
_RIGHT = 150  # [mm] a hit this near to the estimate agrees with it
_VISIT_GAP_NS = 30 * 10**9  # a node's scans farther apart are two visits
_LEAST_SEEN = 3  # scans of a visit that must show an angle bin
_LEAST_BINS = 5  # of an object


def run(_scale: Scale) -> Section | None:
    """Two buildings at three levels; None without the recordings."""
    folder = Path(os.environ.get(_FOLDER, ""))
    logs = {name: [folder / file for file in files] for name, files in _RECORDINGS.items()}
    if not os.environ.get(_FOLDER) or not all(path.exists() for files in logs.values() for path in files):
        print(f"recordings: left as it is, {_FOLDER} does not name their folder", file=sys.stderr)
        return None
    return section({name: measured(files) for name, files in logs.items()})


@dataclass(frozen=True, slots=True)
class Counts:
    """What is counted of one definition at one level, over all nodes."""

    steps: int = 0  # angle bins known in two estimates in a row
    changes: int = 0  # of them: the range differs
    returns: int = 0  # of them: and is back within ten scans
    hits: int = 0  # in the next scan, where the estimate before it is known
    right: int = 0  # of them: near to it
    objects: int = 0  # estimates of changed objects
    halves: int = 0  # of them: half old and half new

    def __add__(self, other: "Counts") -> "Counts":
        return Counts(*(a + b for a, b in zip(self.numbers, other.numbers, strict=True)))

    @property
    def numbers(self) -> tuple[int, ...]:
        """All counts in order."""
        return (*(self.steps, self.changes, self.returns, self.hits, self.right, self.objects, self.halves),)


Found = dict[tuple[str, str], Counts]  # by level and definition


def measured(logs: Sequence[Path]) -> Found:
    """Counts of one building."""
    settings = Settings()
    scans = recorded(logs, settings)
    definitions = {name: DEFINITIONS[name] for name in _COMPARED}
    found: Found = {}
    for i, level in enumerate(levels(settings)):
        nodes = followed(scans, level, definitions, gated=i > 0)
        for name in definitions:
            found[level.name, name] = sum((counted(node, name) for node in nodes), Counts())
    return found


def counted(node: Followed, name: str) -> Counts:
    """Counts of one node and definition."""
    estimates = node.estimates[name]
    if len(estimates) < 2:
        return Counts()
    known = (estimates[1:] < UNSEEN) & (estimates[:-1] < UNSEEN)
    changed = known & differs(estimates[1:], estimates[:-1])
    seen, before = node.ranges[1:], estimates[:-1]
    hits = (seen < CLEAR) & (before < UNSEEN)
    right = hits & (np.abs(seen.astype(np.int64) - before) <= _RIGHT)
    counts = Counts(*(int(x.sum()) for x in (known, changed, _goes_back(estimates, changed), hits, right)))
    objects, halves = _objects(node, estimates)
    return replace(counts, objects=objects, halves=halves)


def differs(a: Ranges, b: Ranges) -> Bools:
    """Where two arrays of ranges differ by more than the larger of 0.2 m and 3 %; clear is far behind all."""
    here, there = a.astype(np.int64), b.astype(np.int64)
    return np.asarray(np.abs(here - there) > np.maximum(_STEP, _STEP_SHARE * np.minimum(here, there)))


def _goes_back(estimates: Ranges, changed: Bools) -> Bools:
    """Which changes (k - 1, angle_bins) are undone within ten scans."""
    back = np.zeros_like(changed)
    for later in range(2, _BACK_WITHIN + 2):
        same = ~differs(estimates[later:], estimates[:-later]) & (estimates[later:] < UNSEEN)
        back[: len(same)] |= same
    return np.asarray(back & changed)


def _objects(node: Followed, estimates: Ranges) -> tuple[int, int]:
    """Estimates of objects that changed from one visit to the next, during the later; and those half old, half new.

    An object is a run of angle bins of which the scans of both visits, by their medians, say different things.
    """
    borders = np.flatnonzero(np.diff(node.stamps_ns) > _VISIT_GAP_NS) + 1
    visits = [rows for rows in np.split(np.arange(len(estimates)), borders) if len(rows) >= _LEAST_SEEN]
    objects = halves = 0
    for before, after in pairwise(visits):
        old, new = _median(node.ranges[before]), _median(node.ranges[after])
        changed = (old < UNSEEN) & (new < UNSEEN) & differs(old, new)
        for run in runs(changed):
            for part in _coherent(run, old, new):
                shown = estimates[after][:, part]
                is_old = (~differs(shown, old[part]) & (shown < UNSEEN)).mean(axis=1)
                is_new = (~differs(shown, new[part]) & (shown < UNSEEN)).mean(axis=1)
                objects += len(shown)
                halves += int(((is_old > 0.1) & (is_new > 0.1)).sum())
    return objects, halves


def _median(ranges: Ranges) -> Ranges:
    """The lower median (angle_bins,) of scans (n, angle_bins), where enough of them see the angle bin."""
    seen = (ranges < UNSEEN).sum(axis=0)
    middle = np.sort(ranges, axis=0)[np.maximum(seen - 1, 0) // 2, np.arange(ranges.shape[1])]
    return np.where(seen >= _LEAST_SEEN, middle, UNSEEN).astype(np.uint16)


def _coherent(run: npt.NDArray[np.int64], old: Ranges, new: Ranges) -> list[npt.NDArray[np.int64]]:
    """A run cut where both the old and the new range jump; what is left of at least five angle bins."""
    jumps = np.abs(np.diff(old[run].astype(np.int64))) > 300
    jumps &= np.abs(np.diff(new[run].astype(np.int64))) > 300
    return [part for part in np.split(run, np.flatnonzero(jumps) + 1) if len(part) >= _LEAST_BINS]


def section(found: Mapping[str, Found]) -> Section:
    """The document's section from the counts of each building."""
    rows: list[tuple[str, ...]] = []
    numbers: dict[str, float] = {}
    for building, counts in found.items():
        for (level, name), c in counts.items():
            flicker, half = c.returns / max(1, c.steps), c.halves / max(1, c.objects)
            changes = number(100 * c.changes / max(1, c.steps), 2)
            rows.append(
                (
                    f"{building}: {level}, {name}", changes, number(100 * flicker, 3),
                    share(half) if c.objects else "-", percent(c.right / max(1, c.hits)),
                )
            )  # fmt: skip
            numbers |= {
                f"{building} {level} {name} flicker": flicker,
                f"{building} {level} {name} half": half,
            }
    header = ("", "changes [% of steps]", "flicker [% of steps]", "half-and-half", "next hits right")
    return Section(
        "Real recordings: flicker and half objects",
        (*_SENTENCES, _verdict(found)),
        (Table(header, rows),),
        (),
        numbers,
    )


def _verdict(found: Mapping[str, Found]) -> str:
    """Where the default shows more than the median per angle bin; the bar is nowhere."""
    worse: dict[str, list[str]] = {"flicker": [], "half-and-half objects": []}
    for building, counts in found.items():
        for level in dict.fromkeys(level for level, _ in counts):
            ours, median = counts[level, "ours"], counts[level, "median per angle bin"]
            if ours.returns * median.steps > median.returns * ours.steps:
                worse["flicker"].append(f"{building}, {level}")
            if ours.halves * median.objects > median.halves * ours.objects:
                worse["half-and-half objects"].append(f"{building}, {level}")
    places = (f"{what}: {'; '.join(where) or 'nowhere'}" for what, where in worse.items())
    return f"Where the default shows more than the median (bar: nowhere): {', '.join(places)}."


_SENTENCES = (
    "Two recordings of real buildings with the default settings, all definitions on the same memory, an "
    "estimate of the node after each scan. *Changes*: of the angle bins that two "
    "estimates in a row know, those in which the range differs by more than 0.2 m and 3 %. *Flicker*: "
    "those that are back within ten scans. *Half-and-half*: objects that changed "
    "from one visit of a node to the next (at least five angle bins; what was and what is, by the medians "
    "of each visit's own scans), and the share of the estimates during the "
    "later visit that show them more than 10 % old and more than 10 % new. *Next hits right*: hits of the "
    "scan after the estimate within 0.15 m of it.",
)
