"""A progress bar on the terminal, and none where nobody watches."""

from types import TracebackType
from typing import TYPE_CHECKING, Self

from timemap_cli.cli.terminal import Terminal

if TYPE_CHECKING:
    from tqdm import tqdm


class ProgressBar:
    """Shows the share of the recordings that has been replayed; to be called with it as the work goes on."""

    def __init__(self, terminal: Terminal, *, quiet: bool = False) -> None:
        self._terminal = terminal
        self._shows = terminal.is_watched() and not quiet
        self._bar: tqdm | None = None

    def __enter__(self) -> Self:
        if self._shows:
            from tqdm import tqdm

            tqdm.monitor_interval = 0  # its thread would be alive when a process is forked
            self._bar = tqdm(
                total=1.0,
                file=self._terminal.stderr,
                leave=False,
                bar_format="{percentage:3.0f}% |{bar:40}| {postfix[0]} scans, {elapsed} + {remaining}",
                postfix=[0],
            )
        return self

    def __call__(self, share: float, scans: int) -> None:
        """Show that `share` (0..1) of the recordings is done and `scans` have been read so far.

        Raises KeyboardInterrupt once more if one got lost on its way.
        """
        if self._terminal.is_interrupted():
            raise KeyboardInterrupt
        if self._bar is not None:
            self._bar.postfix[0] = scans
            self._bar.update(min(share, 1.0) - self._bar.n)

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        if self._bar is not None:
            self._bar.close()
