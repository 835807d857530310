"""What the tests share."""

import os
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[1]


def shared_data(name: str) -> Path:
    """Path of a real recording outside the project; the test is skipped where it is missing."""
    beside = ROOT.parent / "shared" / "data"
    path = Path(os.environ.get("TIMEMAP_SHARED_DATA", beside)) / name
    if not path.exists():
        pytest.skip(f"no recording {name} here")
    return path
