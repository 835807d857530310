"""What an experiment hands back: sentences, tables, figures, and the bare numbers for tests."""

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from enum import Enum
from typing import TYPE_CHECKING, TypeVar

if TYPE_CHECKING:
    from matplotlib.figure import Figure as Canvas

Choice = TypeVar("Choice")


class Scale(Enum):
    """How much of an experiment is run: all of it for the document, or a short version for the tests."""

    full = "full"
    quick = "quick"

    def pick(self, full: Choice, quick: Choice) -> Choice:
        """The one of two values that belongs to this scale."""
        return full if self is Scale.full else quick


@dataclass(frozen=True, slots=True)
class Table:
    """A table of text; the first column is set to the left, numbers to the right."""

    header: Sequence[str]
    rows: Sequence[Sequence[str]]
    caption: str = ""


@dataclass(frozen=True, slots=True)
class Figure:
    """A picture: `draw` fills an empty matplotlib figure, which is only made where pictures are wanted."""

    name: str  # of the file in docs/pictures/paper, without .svg
    caption: str
    draw: "Callable[[Canvas], None]"


@dataclass(frozen=True, slots=True)
class Section:
    """One experiment as it stands in docs/paper.md: sentences first, then tables, then figures."""

    title: str
    sentences: Sequence[str]  # one paragraph each
    tables: Sequence[Table] = ()
    figures: Sequence[Figure] = ()
    numbers: Mapping[str, float] = field(default_factory=dict)  # what the tests look at
