"""docs/check.md says what the program does."""

import re

from tests.conftest import ROOT
from timemap_cli.checks.tolerances import TOLERANCES

DOCUMENT = (ROOT / "docs" / "check.md").read_text()
ROW = re.compile(r"^\| `(\w+\.\w+)` \| ([0-9.]+) ?(\S*) \| (.*) \|$", re.MULTILINE)


def test_every_tolerance_stands_in_the_document_with_its_default():
    told = {}
    for name, number, unit, meaning in ROW.findall(DOCUMENT):
        told[name] = (float(number) / (100 if unit == "%" else 1), "" if unit == "%" else unit, meaning)
    held = {name: (one.default, one.unit, one.meaning) for name, one in TOLERANCES.items()}
    assert told == held
