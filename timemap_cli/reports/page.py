"""A result as one page that needs no network: map, events, time line, memory, settings."""

import html
from collections.abc import Mapping
from importlib.resources import files
from string import Template
from typing import Any

from timemap_cli.errors import UsageError
from timemap_cli.file_names import json_text, shown


def page(title: str, data: Mapping[str, Any]) -> str:
    """The page as HTML; `data` as `page_data` makes it. UsageError where plotly is not installed."""
    folder = files("timemap_cli.reports") / "page"
    parts = {
        name: (folder / name).read_text(encoding="utf-8") for name in ("page.html", "page.css", "page.js")
    }
    return Template(parts["page.html"]).substitute(
        title=html.escape(shown(title)),
        style=parts["page.css"],
        plotly=_plotly(),
        data=_embedded(data),
        script=parts["page.js"],
    )


def _plotly() -> str:
    """The library's JavaScript, which its Python package brings along."""
    try:
        from plotly.offline import get_plotlyjs
    except ImportError as error:
        raise UsageError(
            "a page needs plotly, which is not installed", hint="pip install 'timemap-cli[report]'"
        ) from error
    script: str = get_plotlyjs()
    return script


def _embedded(data: Mapping[str, Any]) -> str:
    """JSON that may stand within a script element: nothing in it can end the element."""
    return json_text(data).replace("<", "\\u003c")
