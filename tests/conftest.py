"""What the tests share."""

import os
from pathlib import Path

import pytest


def shared_data(name: str) -> Path:
    """Path of a real recording outside the project; the test is skipped where it is missing."""
    beside = Path(__file__).parents[2] / "shared" / "data"
    path = Path(os.environ.get("TIMEMAP_SHARED_DATA", beside)) / name
    if not path.exists():
        pytest.skip(f"no recording {name} here")
    return path
