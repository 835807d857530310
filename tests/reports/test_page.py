"""The page as a text."""

import json
import re
import sys
from html.parser import HTMLParser

import pytest

from tests.reports.pages import HOSTILE, write_page_result
from timemap_cli.errors import UsageError
from timemap_cli.reports.page import page
from timemap_cli.reports.page_data import page_data
from timemap_cli.results.reader import ResultReader


class Elements(HTMLParser):
    """Collects what a browser would see."""

    def __init__(self, text):
        super().__init__()
        self.tags, self.attributes, self.texts = [], [], {}
        self.feed(text)

    def handle_starttag(self, tag, attrs):
        self.tags.append(tag)
        self.attributes.extend(attrs)

    def handle_data(self, data):
        self.texts.setdefault(self.tags[-1] if self.tags else "", []).append(data)


@pytest.fixture
def data(tmp_path):
    with ResultReader(write_page_result(tmp_path / "r.timemap.mcap")) as reader:
        return page_data(reader)


@pytest.fixture
def text(data):
    pytest.importorskip("plotly")
    return page(HOSTILE, data)


def test_names_with_html_in_them_stay_text(text):
    found = Elements(text)
    assert found.tags.count("script") == 3  # plotly, the data, the page's own
    assert "img" not in found.tags
    assert HOSTILE in found.texts["title"]


def test_the_data_stand_in_the_page_unchanged(text, data):
    (embedded,) = re.findall(r'<script type="application/json" id="data">(.*?)</script>', text, re.DOTALL)
    assert json.loads(embedded) == data


def test_nothing_is_loaded_from_elsewhere(text):
    found = Elements(text)
    assert not [value for name, value in found.attributes if name in {"src", "href", "srcset", "action"}]
    assert not {"link", "iframe", "img", "object", "embed"} & set(found.tags)
    (policy,) = [value for name, value in found.attributes if name == "content" and "default-src" in value]
    assert policy.startswith("default-src 'none';")
    assert "http" not in policy


def test_without_plotly_the_error_names_what_to_install(data, monkeypatch):
    monkeypatch.setitem(sys.modules, "plotly.offline", None)  # as if it were not there
    with pytest.raises(UsageError, match=r"^a page needs plotly, which is not installed$") as raised:
        page("r", data)
    assert raised.value.hint == "pip install 'timemap-cli[report]'"
