"""Run the experiments, print their tables, write docs/paper.md.

python -m benchmarks.paper [--only NAME ...] [--quick] [--png FOLDER]

A quick run only prints. `--png` draws the figures into a folder as well, to look at.
"""

import argparse
import time
from collections.abc import Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor
from dataclasses import dataclass
from pathlib import Path

from benchmarks.paper import experiments
from benchmarks.paper.document import PICTURES, document, markdown, plain
from benchmarks.paper.section import Scale, Section

_DOCS = Path(__file__).parents[2] / "docs"


@dataclass(frozen=True, slots=True)
class _Finished:
    name: str
    printed: str
    markdown: str
    pictures: dict[str, bytes]  # by file name
    seconds: float


def main(arguments: Sequence[str] | None = None) -> None:
    """Run what the command line asks for."""
    options = _options(arguments)
    scale = Scale.quick if options.quick else Scale.full
    names = [name for name in experiments.NAMES if not options.only or name in options.only]
    for done in _finished(names, scale, bool(options.png)):
        print(f"{done.printed}\n[{done.name}: {done.seconds:.0f} s]\n", flush=True)
        if options.png:
            options.png.mkdir(parents=True, exist_ok=True)
        for file, content in done.pictures.items():
            folder = options.png if file.endswith(".png") else _DOCS / PICTURES
            if scale is Scale.full or folder == options.png:
                folder.joinpath(file).write_bytes(content)
        if scale is Scale.full:
            _write({done.name: done.markdown})


def _options(arguments: Sequence[str] | None) -> argparse.Namespace:
    parser = argparse.ArgumentParser(prog="python -m benchmarks.paper")
    parser.add_argument("--only", nargs="+", choices=experiments.NAMES, default=[], metavar="NAME")
    parser.add_argument("--quick", action="store_true", help="short versions, printed only")
    parser.add_argument("--png", type=Path, help="a folder for the figures as PNG")
    return parser.parse_args(arguments)


def _finished(names: Sequence[str], scale: Scale, png: bool) -> Iterator[_Finished]:
    """Experiments as they end: two at a time, and what is measured in time by itself, after the others."""
    together = [name for name in names if name not in experiments.ALONE]
    with ProcessPoolExecutor(max_workers=2) as pool:
        for found in pool.map(_finish, together, [scale] * len(together), [png] * len(together)):
            if found:
                yield found
    for name in names:
        if name in experiments.ALONE and (found := _finish(name, scale, png)):
            yield found


def _finish(name: str, scale: Scale, png: bool) -> _Finished | None:
    start = time.perf_counter()
    section = experiments.run(name, scale)
    if section is None:
        return None
    pictures = _pictures(section, png) if scale is Scale.full or png else {}
    return _Finished(name, plain(section), markdown(section), pictures, time.perf_counter() - start)


def _pictures(section: Section, png: bool) -> dict[str, bytes]:
    from benchmarks.paper.pictures import rendered, svg

    pictures = {f"{figure.name}.svg": svg(figure) for figure in section.figures}
    if png:
        pictures |= {f"{figure.name}.png": rendered(figure, "png") for figure in section.figures}
    return pictures


def _write(sections: dict[str, str]) -> None:
    path = _DOCS / "paper.md"
    old = path.read_text() if path.exists() else ""
    path.write_text(document(experiments.NAMES, old, sections))


if __name__ == "__main__":
    main()
