import json
from dataclasses import replace
from xml.etree import ElementTree as ET

import pytest

from tests.reports.checks import ERROR, FAILED, LOST, PASSED, SCANS, UNEQUAL, verdict
from timemap_cli.checks.verdict import CheckedCase, exit_code_of
from timemap_cli.errors import UsageError
from timemap_cli.reports.check_github import check_github
from timemap_cli.reports.check_json import check_json
from timemap_cli.reports.check_junit import check_junit
from timemap_cli.reports.check_markdown import check_markdown
from timemap_cli.reports.check_text import check_text

ALL = (FAILED, PASSED, ERROR, LOST, UNEQUAL)


@pytest.mark.parametrize(
    ("cases", "code"),
    [
        ([PASSED], 0),
        ([LOST, PASSED], 3),
        ([FAILED, LOST, PASSED], 4),
        ([UNEQUAL], 4),
        ([ERROR, PASSED], 2),
        ([ERROR, FAILED], 4),
    ],
)
def test_the_exit_code_is_that_of_the_gravest_case(cases, code):
    assert exit_code_of(cases) == code


def test_text_names_the_worst_first_then_the_place_then_the_cause():
    assert check_text([FAILED]) == (
        "failed  hall against hall.yaml: 2 of 3 figures out of tolerance\n"
        "\n"
        "  ranges.places (long)  1 place, allowed 0 places  surfaces moved at 1 place\n"
        "  ranges.moved (long)   4 %, allowed 3 %           4.00 % of 100 angle bins moved\n"
        "\n"
        "  place [m]   level  what moved\n"
        "  1.50, 2.25  long   70 ends off by 0.15 m, seen from nodes 4, 5\n"
        "\n"
        "  likely:  something moved: 50 %, <here>\n"
        "\n"
        "  note:    a note"
    )


def test_text_of_several_checks_ends_with_their_count():
    lines = check_text(ALL).splitlines()
    assert "passed  yard against yard.yaml: 1 figure within tolerance" in lines
    assert "error   roof: there is no file roof.yaml" in lines
    assert "failed  gate against gate.yaml: 1 figure within tolerance, not the same to the digest" in lines
    assert lines[-1] == "5 checks: 2 passed, 2 failed, 1 error."


def test_json_has_every_figure_and_the_exit_code():
    document = json.loads(check_json(ALL), parse_constant=pytest.fail)
    assert document["schema"] == "timemap.check/1"
    assert document["exit_code"] == 4
    assert document["summary"] == {"passed": 2, "failed": 2, "error": 1}
    hall, yard, roof, dock, gate = document["checks"]
    assert [one["name"] for one in hall["measures"]] == ["scans.read", "ranges.moved", "ranges.places"]
    assert hall["measures"][2]["spots"] == [
        {"x": 1.5, "y": 2.25, "text": "70 ends off by 0.15 m, seen from nodes 4, 5", "nodes": [4, 5]}
    ]
    assert hall["measures"][1] | {"text": "", "spots": []} == {
        "name": "ranges.moved",
        "level": "long",
        "value": 0.04,
        "allowed": 0.03,
        "unit": "share",
        "passed": False,
        "text": "",
        "spots": [],
    }
    assert (yard["outcome"], yard["unequal"]) == ("passed", None)
    assert (roof["outcome"], roof["error"], roof["measures"]) == ("error", "there is no file roof.yaml", [])
    assert (dock["data_lost"], dock["warnings"]) == (True, ["dock.bag is cut off"])
    assert gate["unequal"] == ["the change events"]


# What the schemas of Jenkins (junit-10.xsd) and Maven Surefire demand of an element: attributes, children in order.
DEMANDED = {
    "testsuites": ([], ["testsuite"]),
    "testsuite": (["name", "tests", "failures", "errors", "skipped", "time"], ["properties", "testcase"]),
    "properties": ([], ["property"]),
    "property": (["name", "value"], []),
    "testcase": (["name", "classname", "time"], ["failure", "error"]),
    "failure": (["type", "message"], []),
    "error": (["type", "message"], []),
}


def test_junit_has_the_attributes_and_the_order_that_the_schemas_demand():
    root = ET.fromstring(check_junit(ALL))
    assert root.tag == "testsuites"
    for element in root.iter():
        attributes, children = DEMANDED[element.tag]
        assert set(attributes) <= set(element.keys())
        places = [children.index(child.tag) for child in element]
        assert places == sorted(places)


def test_junit_counts_what_it_holds():
    root = ET.fromstring(check_junit(ALL))
    counts = {
        suite.get("name"): (suite.get("tests"), suite.get("failures"), suite.get("errors")) for suite in root
    }
    assert counts == {
        "hall": ("3", "2", "0"),
        "yard": ("1", "0", "0"),
        "roof": ("1", "0", "1"),
        "dock": ("1", "0", "0"),
        "gate": ("2", "1", "0"),
    }
    assert (root.get("tests"), root.get("failures"), root.get("errors")) == ("8", "3", "1")


def test_a_junit_failure_tells_figure_place_and_cause():
    failure = ET.fromstring(check_junit([FAILED])).find(".//testcase[@name='ranges.places (long)']/failure")
    assert failure.get("message") == "1 place, allowed 0 places: surfaces moved at 1 place"
    assert failure.text.splitlines()[1:] == [
        "1.50, 2.25: 70 ends off by 0.15 m, seen from nodes 4, 5",
        "likely cause: something moved: 50 %, <here>",
    ]


def test_junit_survives_letters_that_xml_forbids():
    odd = CheckedCase("a\x00b\x1b", "c.yaml", None, UsageError("d\ufffe<&\"'"))
    suite = ET.fromstring(check_junit([odd]))[0]
    assert suite.get("name") == "a?b?"
    assert suite.find("testcase/error").get("message") == "d?<&\"'"


def test_github_annotations_are_escaped_as_its_runner_reads_them():
    worst, other = check_github([FAILED]).splitlines()
    assert worst == (
        "::error file=hall.yaml,title=timemap check hall%3A ranges.places (long)::"
        "surfaces moved at 1 place (1 place, allowed 0 places)%0Alikely: something moved: 50 %25, <here>"
    )
    assert other.endswith("::4.00 %25 of 100 angle bins moved (4 %25, allowed 3 %25)")


def test_github_commas_and_colons_in_a_file_s_name_do_not_end_it():
    odd = CheckedCase("x", "a,b:c%.yaml", None, UsageError("gone"))
    assert check_github([odd]) == "::error file=a%2Cb%3Ac%25.yaml,title=timemap check x::gone"


def test_github_tells_what_passed_as_a_notice_and_lost_data_as_a_warning():
    assert check_github([PASSED, LOST]).splitlines() == [
        "::notice file=yard.yaml,title=timemap check yard::the one figure is within tolerance",
        "::warning file=dock.yaml,title=timemap check dock::the one figure is within tolerance%0Adock.bag is cut off",
    ]


def test_markdown_has_a_row_for_each_failure_and_all_figures_folded():
    text = check_markdown([FAILED, PASSED, ERROR])
    assert "| ranges.places (long) | 1 place | 0 places | surfaces moved at 1 place |" in text
    assert "- something moved: 50 %, &lt;here>" in text
    assert "<details><summary>All 3 figures, against hall.yaml</summary>" in text
    assert "### ✅ yard: passed\n\nThe one figure is within tolerance." in text
    assert "there is no file roof.yaml" in text


def test_a_pipe_in_a_name_does_not_end_a_cell_of_markdown():
    assert "### ⚠️ a\\|b\\_c: error" in check_markdown([CheckedCase("a|b_c", "d", None, UsageError("e"))])


def test_a_name_inside_of_an_element_of_markdown_has_no_backslashes():
    text = check_markdown([CheckedCase("x", "a_b/<c>\r\n&.yaml", verdict("x", SCANS))])
    assert "<summary>All 1 figures, against a_b/&lt;c> &amp;.yaml</summary>" in text


def test_lost_data_is_told_wherever_the_check_passed():
    assert "**Data was lost**\n\n- dock.bag is cut off\n" in check_markdown([LOST])
    properties = ET.fromstring(check_junit([LOST]))[0].find("properties")
    assert ("warning", "dock.bag is cut off") in [(one.get("name"), one.get("value")) for one in properties]


def test_github_tells_lost_data_of_a_failed_check_too():
    last = check_github([replace(FAILED, lost=True, warnings=("hall.bag is cut off",))]).splitlines()[-1]
    assert last == "::warning file=hall.yaml,title=timemap check hall::hall.bag is cut off"
