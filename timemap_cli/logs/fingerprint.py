"""What a recording's bytes are, to tell later whether it is the same."""

import hashlib
from pathlib import Path

from timemap_cli.errors import TimemapError


def sha256(path: Path) -> str:
    """SHA-256 of a file; of a folder, that of its files' names and digests in order of name. Raises TimemapError."""
    try:
        if path.is_dir():
            files = sorted(file for file in path.iterdir() if file.is_file())
            lines = "".join(f"{sha256(file)}  {file.name}\n" for file in files)
            return hashlib.sha256(lines.encode(errors="surrogateescape")).hexdigest()
        with path.open("rb") as file:
            return hashlib.file_digest(file, "sha256").hexdigest()
    except OSError as error:
        raise TimemapError(f"cannot read {path}: {error.strerror}") from error
