"""matplotlib without a word on stderr, and without a file of its own anywhere."""

import logging
import os
import warnings
from collections.abc import Iterator, Mapping
from contextlib import AbstractContextManager, contextmanager, nullcontext
from tempfile import TemporaryDirectory
from typing import Any


@contextmanager
def quiet_matplotlib() -> Iterator[None]:
    """Within it matplotlib is imported and draws; also as a decorator.

    Its list of fonts goes to a temporary folder, or to MPLCONFIGDIR where the user names one. Only its own fonts are
    looked for: that takes 0.4 s, where a system's may take seconds, and gives one picture on all machines. Nor does
    a `matplotlibrc` that lies about change a picture.
    """
    logger = logging.getLogger("matplotlib")
    level = logger.level
    with TemporaryDirectory(prefix="timemap-") as folder, _surroundings(folder), warnings.catch_warnings():
        warnings.simplefilter("ignore")  # letters that no font has, and the like: the picture shows it
        logger.setLevel(logging.CRITICAL + 1)
        try:
            with _defaults():
                yield
        finally:
            logger.setLevel(level)


@contextmanager
def _surroundings(folder: str) -> Iterator[None]:
    """The environment in which neither matplotlib nor the programs that it asks find the user's folders."""
    mine = dict.fromkeys(("HOME", "XDG_CACHE_HOME", "XDG_CONFIG_HOME"), folder)
    mine |= {"MPLCONFIGDIR": os.environ.get("MPLCONFIGDIR") or folder, "MPL_IGNORE_SYSTEM_FONTS": "1"}
    before: Mapping[str, str | None] = {name: os.environ.get(name) for name in mine}
    os.environ.update(mine)
    try:
        yield
    finally:
        for name, value in before.items():
            os.environ.pop(name)
            if value is not None:
                os.environ[name] = value


def _defaults() -> AbstractContextManager[Any]:
    """A context of matplotlib's own settings; an empty one where it is missing, which is told where it is needed."""
    try:
        import matplotlib as mpl
    except ImportError:
        return nullcontext()
    return mpl.rc_context({name: value for name, value in mpl.rcParamsDefault.items() if name != "backend"})
