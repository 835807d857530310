"""Completion by the shell: the lines that set it up, and what fits the words so far."""

from typing import TYPE_CHECKING

from timemap_cli.errors import UsageError

if TYPE_CHECKING:
    import click

VARIABLE = "_TIMEMAP_COMPLETE"  # as click's own lines for the shells set it
_SHELLS = ("bash", "zsh", "fish")


def completion(command: "click.Command", instruction: str) -> str:
    """What the shell asks for by `VARIABLE`: "bash_source" is the lines to set it up, "bash_complete" what fits.

    UsageError for another shell or question.
    """
    from click.shell_completion import get_completion_class

    shell, _, question = instruction.partition("_")
    kind = get_completion_class(shell) if shell in _SHELLS else None
    if kind is None or question not in ("source", "complete"):
        raise UsageError(
            f"{VARIABLE} is {instruction}: there is completion for {', '.join(_SHELLS[:-1])} and {_SHELLS[-1]}",
            hint=f'eval "$({VARIABLE}=bash_source timemap)"',
        )
    asked = kind(command, {}, "timemap", VARIABLE)
    try:
        return asked.source() if question == "source" else asked.complete()
    except (KeyError, ValueError) as error:
        raise UsageError(
            "what the shell wants completed is not in COMP_WORDS and COMP_CWORD",
            hint=f'eval "$({VARIABLE}={shell}_source timemap)"',
        ) from error
