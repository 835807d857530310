"""Random numbers as a function of what they decide, never of a shared stream.

Adding a node or a level, or taking scans in other blocks, must change nothing else. So each number is computed from
its own key and counters: SplitMix64 (Steele, Lea, Flood 2014), which is integer arithmetic and the same everywhere.
"""

from hashlib import blake2b

import numpy as np
import numpy.typing as npt

from timemap_cli.model.nodes import Node

Keys = npt.NDArray[np.uint64]

_GOLDEN = np.uint64(0x9E3779B97F4A7C15)


def key(seed: int, node: Node, level: str) -> int:
    """64-bit key of one node and level; the node's centre counts in whole millimetres."""
    centre = f"{round(node.x * 1000)} {round(node.y * 1000)}"
    return int.from_bytes(blake2b(f"{seed} {centre} {level}".encode(), digest_size=8).digest(), "little")


def mixed(keys: Keys, counter: npt.NDArray[np.int64] | int) -> Keys:
    """One 64-bit number for each key and counter (shapes broadcast); usable as keys again."""
    with np.errstate(over="ignore"):
        z = keys + (np.asarray(counter, np.uint64) + np.uint64(1)) * _GOLDEN
        z ^= z >> np.uint64(30)
        z *= np.uint64(0xBF58476D1CE4E5B9)
        z ^= z >> np.uint64(27)
        z *= np.uint64(0x94D049BB133111EB)
        z ^= z >> np.uint64(31)
    return np.asarray(z)


def below(numbers: Keys, limit: int) -> npt.NDArray[np.int64]:
    """Numbers 0 .. limit - 1 from the upper 32 bits of random ones; limit at most 2^31."""
    return ((numbers >> np.uint64(32)) * np.uint64(limit) >> np.uint64(32)).astype(np.int64)
