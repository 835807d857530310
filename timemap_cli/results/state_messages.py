"""`/timemap/state`: what a later replay needs to go on, as plain numbers and texts, in messages of bounded size."""

import json
import math
from dataclasses import dataclass
from enum import Enum

import numpy as np

from timemap_cli.model.state import State
from timemap_cli.results.cdr import CdrBuilder, CdrParser

FORMAT = "timemap.state/3"  # changes whenever a replay keeps other things, or means something else by them
_TYPES = ("|b1", "|u1", "<u2", "<u4", "<i4", "<i8", "<u8", "<f4", "<f8")


class Part(Enum):
    """What a part of the state is of."""

    READING = "reading"  # the recordings, their scans and poses
    LEARNING = "learning"  # the memory as a whole
    NODE = "node"  # all that is remembered of one node
    CHANGES = "changes"  # the change events


@dataclass(frozen=True, slots=True)
class StatePart:
    """What one message holds."""

    part: Part
    node: int  # its number; 0 where the part is of no node
    state: State


def pack_state(kept: StatePart, stamp_ns: int, map_frame: str) -> bytes:
    """`timemap_msgs/State`."""
    arrays = {name: value for name, value in kept.state.items() if isinstance(value, np.ndarray)}
    plain = {name: value for name, value in kept.state.items() if name not in arrays}
    cdr = CdrBuilder()
    cdr.header(stamp_ns, map_frame)
    cdr.string(kept.part.value)
    cdr.pack("I", kept.node)
    cdr.string(json.dumps(plain, separators=(",", ":")))
    cdr.pack("I", len(arrays))
    for name, array in arrays.items():
        little = np.ascontiguousarray(array, array.dtype.newbyteorder("<"))
        cdr.string(name)
        cdr.string(little.dtype.str)
        cdr.pack("I", array.ndim, *array.shape)
        cdr.octets(little.tobytes())
    return cdr.message()


def unpack_state(message: bytes) -> StatePart:
    """The part of the state that a message holds; ValueError or struct.error if it holds none."""
    cdr = CdrParser(message)
    cdr.header()
    part = Part(cdr.string())
    (node,) = cdr.unpack("I")
    state: State = json.loads(cdr.string())
    if not isinstance(state, dict):
        raise ValueError("a state is a mapping")
    (count,) = cdr.unpack("I")
    for _ in range(count):
        name, kind = cdr.string(), cdr.string()
        (n_dim,) = cdr.unpack("I")
        shape = cdr.unpack("I", n_dim)
        octets = cdr.octets()
        if kind not in _TYPES or math.prod(shape) * np.dtype(kind).itemsize != len(octets):
            raise ValueError(f"the array {name} does not have its shape")
        state[name] = np.frombuffer(octets, kind).reshape(shape)
    return StatePart(part, node, state)
