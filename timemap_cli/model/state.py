"""What a part of a replay has to keep so that another replay can go on where it stopped."""

from typing import Any

State = dict[str, Any]
"""By name: NumPy arrays of numbers, and what JSON can hold."""


def prefixed(prefix: str, state: State) -> State:
    """A state under longer names, to stand beside others: `without_prefix` takes them off."""
    return {f"{prefix}.{name}": value for name, value in state.items()}


def without_prefix(prefix: str, state: State) -> State:
    """Of a state, what `prefixed` put under a prefix."""
    start = f"{prefix}."
    return {name.removeprefix(start): value for name, value in state.items() if name.startswith(start)}
