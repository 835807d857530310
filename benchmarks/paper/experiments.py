"""All experiments, in the order of docs/paper.md. Each is a module with `run(scale) -> Section | None`."""

from importlib import import_module
from typing import Protocol, cast

from benchmarks.paper.section import Scale, Section

NAMES = (
    "fig6",
    "fig7",
    "unseen",
    "fig8",
    "table1",
    "removed",
    "door",
    "person",
    "parked",
    "half_life",
    "bin_edges",
    "rivals_table",
    "failures",
    "calibration",
    "recordings",
)
ALONE = ("table1",)  # measured in time: nothing runs beside them


class _Experiment(Protocol):
    def run(self, scale: Scale) -> Section | None: ...


def run(name: str, scale: Scale) -> Section | None:
    """Run one experiment; None where what it needs is not there, and its old section stays."""
    return cast(_Experiment, import_module(f"benchmarks.paper.{name}")).run(scale)
