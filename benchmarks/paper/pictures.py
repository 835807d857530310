"""Figures as SVG files that are the same bytes on every run."""

import io
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import matplotlib as mpl
from matplotlib.figure import Figure as Canvas

from benchmarks.paper.section import Figure

_STYLE: Any = {
    "svg.hashsalt": "timemap",  # else the ids of clip paths are random
    "svg.fonttype": "none",
    "font.size": 9.0,
    "axes.spines.top": False,
    "axes.spines.right": False,
    "axes.grid": True,
    "grid.alpha": 0.25,
    "lines.linewidth": 1.4,
    "legend.frameon": False,
}


def svg(figure: Figure) -> bytes:
    """The file of one figure: no date, fixed ids, text as text."""
    return rendered(figure, "svg")


def rendered(figure: Figure, kind: str) -> bytes:
    """One figure as "svg" or "png"."""
    with _style():
        canvas = Canvas(figsize=(8.0, 3.4), layout="constrained")
        figure.draw(canvas)
        out = io.BytesIO()
        metadata = {"Date": None, "Creator": None} if kind == "svg" else None
        canvas.savefig(out, format=kind, metadata=metadata, dpi=110)
    return out.getvalue()


@contextmanager
def _style() -> Iterator[None]:
    with mpl.rc_context(_STYLE):
        yield
