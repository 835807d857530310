"""One rule for what another version of timemap wrote, be it a result, a state in it, a document or a baseline.

Each has a format, a name with a number: `timemap.result/2`. The number goes up whenever the one before would be read
wrongly; a field more is no reason. A timemap reads its own number, and of other numbers those that it is taught to
convert; for the rest there is one error, which names both versions.
"""

import re
from pathlib import Path

from timemap_cli import __version__
from timemap_cli.errors import UsageError, shown


def require_readable(path: Path, found: object, reads: str, version: object, anew: str) -> None:
    """UsageError for the format of another version; ValueError for what is no number of this format at all.

    `version` is the timemap that wrote it, `anew` says how it is made again.
    """
    if found == reads:
        return
    name = re.escape(reads.partition("/")[0])
    if not isinstance(found, str) or not re.fullmatch(rf"{name}/[0-9]{{1,6}}", found):
        raise ValueError(f"{shown(found)} is no {reads}")
    other = f"timemap {shown(version)}"
    raise UsageError(
        f"{path} holds {found} of {other}; this is timemap {__version__}, which reads {reads}",
        hint=f"{other} reads it; or {anew}",
    )
