"""What a page of a result shows, as values that JSON knows."""

import base64
import zlib
from typing import Any

import numpy as np
import numpy.typing as npt

from timemap_cli.model.estimates import Estimate
from timemap_cli.results.reader import ResultReader

MOST_STEPS = 240  # of the time slider
_PER_METRE = 100  # a centimetre is finer than the screen
_UNKNOWN, _CLEAR = 65535, 65534


def page_data(reader: ResultReader) -> dict[str, Any]:
    """Everything a page shows of a result: estimates over time, events, how the memory was filled, provenance.

    Ranges are in whole centimetres, as zlib streams in base64: uint16 little endian, 65534 clear, 65535 unknown.
    Where there are more times than MOST_STEPS, each node's newest estimates at so many of them are kept.
    """
    history = {level: list(reader.history(level)) for level in reader.levels}
    times = _steps(sorted({log_ns for made in history.values() for log_ns, _ in made}))
    report = reader.report
    return {
        "levels": list(reader.levels),
        "angle_bins": reader.angle_bins,
        "nodes": [[round(node.x, 3), round(node.y, 3)] for node in reader.nodes],
        "times": [str(time) for time in times.tolist()],
        "estimates": {
            level: _packed(_kept(made, times), reader.angle_bins) for level, made in history.items()
        },
        "coverage": _coverage(reader),
        "changes": reader.changes,
        "report": report,
        "inputs": reader.inputs,
        "settings": reader.config,
        "made": [
            [name, reader.metadata[name]]
            for name in ("version", "map_frame", "settings_sha256", "seed", "format")
            if name in reader.metadata
        ],
    }


def _steps(times: list[int]) -> npt.NDArray[np.int64]:
    """At most MOST_STEPS of the times, the last among them."""
    chosen = np.linspace(0, len(times) - 1, min(len(times), MOST_STEPS)).round().astype(np.int64)
    return np.array(times, np.int64)[np.unique(chosen)]


def _kept(made: list[tuple[int, Estimate]], times: npt.NDArray[np.int64]) -> list[tuple[int, Estimate]]:
    """Step and newest estimate of each node within each step, in their order."""
    newest: dict[tuple[int, int], Estimate] = {}
    for log_ns, estimate in made:
        newest[int(np.searchsorted(times, log_ns)), estimate.node] = estimate
    return [(step, estimate) for (step, _), estimate in sorted(newest.items(), key=lambda item: item[0])]


def _packed(kept: list[tuple[int, Estimate]], angle_bins: int) -> dict[str, str]:
    ranges = np.array([estimate.ranges for _, estimate in kept], np.float64).reshape(len(kept), angle_bins)
    steps, nodes = np.array([(step, one.node) for step, one in kept], np.int64).reshape(len(kept), 2).T
    return packed(steps, nodes, ranges)


def packed(
    steps: npt.NDArray[np.int64], nodes: npt.NDArray[np.int64], ranges: npt.NDArray[np.float64]
) -> dict[str, str]:
    """Rows of ranges (n, angle_bins) [m] with their steps and nodes (n,), as the page reads them."""
    whole = np.full(ranges.shape, _UNKNOWN, "<u2")
    finite = np.isfinite(ranges)
    whole[finite] = np.rint(ranges[finite] * _PER_METRE)
    whole[np.isposinf(ranges)] = _CLEAR
    arrays = {"step": steps.astype("<u2"), "node": nodes.astype("<u4"), "ranges": whole}
    return {name: base64.b64encode(zlib.compress(array.tobytes())).decode() for name, array in arrays.items()}


def _coverage(reader: ResultReader) -> dict[str, list[int]]:
    """How many angle bins each level knows at the end, by node."""
    found: dict[str, list[int]] = {"nodes": list(range(len(reader.nodes)))}
    for level in reader.levels:
        estimates = reader.estimates(level)
        found[level] = [
            int(np.count_nonzero(~np.isnan(estimates[node].ranges))) if node in estimates else 0
            for node in found["nodes"]
        ]
    return found
