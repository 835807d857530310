"""Checks as JUnit XML: a suite for each check, a test case for each figure; valid for Jenkins and Surefire."""

import re
from collections.abc import Sequence
from xml.etree import ElementTree as ET

from timemap_cli.checks.verdict import CheckedCase, Measure, Verdict
from timemap_cli.file_names import shown
from timemap_cli.reports.check_values import compared, title

_FORBIDDEN = re.compile("[^\t\n\r -\ud7ff\ue000-\ufffd\U00010000-\U0010ffff]")  # in XML 1.0
_NO_TIME = "0"  # how long it took would make every file another one


def check_junit(cases: Sequence[CheckedCase]) -> str:
    """The document; the same checks give the same text."""
    suites = [_suite(case) for case in cases]
    root = ET.Element("testsuites", {"name": "timemap check", **_sums(suites), "time": _NO_TIME})
    root.extend(suites)
    ET.indent(root)
    return '<?xml version="1.0" encoding="UTF-8"?>\n' + ET.tostring(root, encoding="unicode") + "\n"


def _suite(case: CheckedCase) -> ET.Element:
    tests = _error(case) if case.verdict is None else _tests(case, case.verdict)
    counts = {
        "tests": str(len(tests)),
        "failures": str(sum(test.find("failure") is not None for test in tests)),
        "errors": str(sum(test.find("error") is not None for test in tests)),
    }
    suite = ET.Element("testsuite", {"name": _text(case.name), **counts, "skipped": "0", "time": _NO_TIME})
    _add_properties(suite, case)
    suite.extend(tests)
    return suite


def _add_properties(suite: ET.Element, case: CheckedCase) -> None:
    """What is said of the check as a whole; Surefire knows no text beside the test cases."""
    told = [("baseline", case.baseline)]
    if case.verdict:
        told += [("likely cause", cause) for cause in case.verdict.causes]
        told += [("note", note) for note in case.verdict.notes if note not in case.verdict.causes]
    told += [("warning", warning) for warning in case.warnings]
    properties = ET.SubElement(suite, "properties")
    for name, value in told:
        ET.SubElement(properties, "property", {"name": name, "value": _text(value)})


def _tests(case: CheckedCase, verdict: Verdict) -> list[ET.Element]:
    tests = [_test(case, title(measure)) for measure in verdict.measures]
    for test, measure in zip(tests, verdict.measures, strict=True):
        if not measure.passed:
            _add_failure(test, measure, verdict.causes)
    if verdict.unequal is not None:
        tests.append(_test(case, "exact"))
        if verdict.unequal:
            told = "; ".join(verdict.unequal)
            failure = ET.SubElement(tests[-1], "failure", {"message": _text(told), "type": "exact"})
            failure.text = _text(told)
    return tests


def _error(case: CheckedCase) -> list[ET.Element]:
    test = _test(case, "comparison")
    message = case.error.message if case.error else "nothing was compared"
    error = ET.SubElement(test, "error", {"message": _text(message), "type": "comparison"})
    error.text = _text("\n".join([message, *([case.error.hint] if case.error and case.error.hint else [])]))
    return [test]


def _test(case: CheckedCase, name: str) -> ET.Element:
    place = {"classname": f"timemap.check.{_text(case.name)}", "name": name, "time": _NO_TIME}
    return ET.Element("testcase", place)


def _add_failure(test: ET.Element, measure: Measure, causes: Sequence[str]) -> None:
    message = f"{compared(measure)}: {measure.text}"
    failure = ET.SubElement(test, "failure", {"message": _text(message), "type": measure.name})
    spots = [f"{spot.x:.2f}, {spot.y:.2f}: {spot.text}" for spot in measure.spots]
    likely = [f"likely cause: {cause}" for cause in causes]
    failure.text = _text("\n".join([message, *spots, *likely]))


def _sums(suites: Sequence[ET.Element]) -> dict[str, str]:
    return {
        name: str(sum(int(suite.get(name, "0")) for suite in suites))
        for name in ("tests", "failures", "errors")
    }


def _text(text: str) -> str:
    """Without the characters that XML does not allow, control characters in a file's name for instance."""
    return _FORBIDDEN.sub("?", shown(text))
