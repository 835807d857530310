"""The page in a real browser: Chromium, without a screen, driven by selenium."""

import json
import shutil

import pytest

from tests.cli.program import timemap
from tests.cli.result_files import all_levels, write
from tests.reports.pages import APPEARED, GONE_AGAIN, HOSTILE, REPORT, write_page_result
from timemap_cli.reports.page import page
from timemap_cli.reports.page_data import page_data
from timemap_cli.results.reader import ResultReader

pytest.importorskip("plotly")
webdriver = pytest.importorskip("selenium.webdriver")

FLAGS = (
    "--headless",
    "--no-sandbox",
    "--disable-gpu",
    "--disable-background-networking",
    "--use-gl=angle",
    "--use-angle=swiftshader",
    "--enable-unsafe-swiftshader",
    "--window-size=1280,1000",
)
PATIENCE_S = 30


@pytest.fixture(scope="module")
def driver():
    """A browser for all tests of this file; they are skipped where there is none."""
    browser = shutil.which("chromium") or shutil.which("google-chrome")
    service = shutil.which("chromedriver")
    if not browser or not service:
        pytest.skip("no Chromium with its chromedriver here")
    options = webdriver.ChromeOptions()
    options.binary_location = browser
    for flag in FLAGS:
        options.add_argument(flag)
    options.set_capability("goog:loggingPrefs", {"performance": "ALL", "browser": "ALL"})
    driver = webdriver.Chrome(options=options, service=webdriver.ChromeService(service))
    yield driver
    driver.quit()


@pytest.fixture(scope="module")
def address(tmp_path_factory):
    """Address of a page on disk."""
    folder = tmp_path_factory.mktemp("page")
    with ResultReader(write_page_result(folder / "r.timemap.mcap")) as reader:
        text = page(HOSTILE, page_data(reader))
    (folder / "r.html").write_text(text)
    return (folder / "r.html").as_uri()


@pytest.fixture
def opened(driver, address):
    """The browser with the page loaded and drawn."""
    return open_page(driver, address)


def open_page(driver, address):
    driver.get_log("browser")
    driver.get_log("performance")
    driver.get(address)
    wait(driver).until(lambda d: d.execute_script("return document.body.dataset.ready") == "yes")
    return driver


def wait(driver):
    from selenium.webdriver.support.ui import WebDriverWait

    return WebDriverWait(driver, PATIENCE_S)


def too_wide(driver):
    """Names of the elements whose contents do not fit into them."""
    return driver.execute_script(
        "return [...document.querySelectorAll('body, section, .scroll, .bar')]"
        ".filter((e) => e.scrollWidth > e.clientWidth + 1).map((e) => e.id || e.className || e.tagName)"
    )


def element(driver, selector):
    return driver.find_element("css selector", selector)


def plan(driver, name):
    """Points of a trace of the plan that may be seen: [[x, y], ...]."""
    return driver.execute_script(
        "const t = document.getElementById('plan').data.find((t) => t.name === arguments[0]);"
        "return t.visible === false ? [] : Array.from(t.x, (x, i) => [x, t.y[i]]);",
        name,
    )


def slide(driver, step):
    driver.execute_script(
        "const s = document.getElementById('time'); s.value = arguments[0]; s.dispatchEvent(new Event('input'));",
        step,
    )


def near(points, x, y):
    return [p for p in points if p[0] is not None and (p[0] - x) ** 2 + (p[1] - y) ** 2 < 0.3**2]


def test_the_slider_moves_the_estimates(opened):
    element(opened, "#level-mid").click()
    assert len(near(plan(opened, "mid"), 1.0, 4.0)) > 0  # the box, 2 m to the left of the node
    assert element(opened, "#now").text == "2023-11-14 22:13:40 UTC"
    slide(opened, 1)
    assert near(plan(opened, "mid"), 1.0, 4.0) == []
    assert element(opened, "#now").text == "2023-11-14 22:13:30 UTC"


def test_the_slider_moves_the_pixels(opened):
    element(opened, "#level-mid").click()
    drawn = element(opened, "#plan").screenshot_as_png
    slide(opened, 0)
    assert element(opened, "#plan").screenshot_as_png != drawn


def test_the_plan_shows_the_changes_that_held_at_the_chosen_time(opened):
    here = [APPEARED["x"], APPEARED["y"]]
    gone = [GONE_AGAIN["x"], GONE_AGAIN["y"]]
    assert plan(opened, "events") == [here]
    slide(opened, 0)
    assert plan(opened, "events") == [gone]
    slide(opened, 1)
    assert plan(opened, "events") == []  # one is undone at 10 s, the other comes at 20 s


def test_a_click_on_a_change_selects_it_and_a_node_that_tells_of_it(opened):
    assert element(opened, "#node-title").text == "Node 0: what each level holds"
    row = element(opened, f"#events tr[data-event='{GONE_AGAIN['id']}']")
    assert "chosen" not in row.get_attribute("class")
    row.click()
    chosen = opened.find_elements("css selector", "#events tr.chosen")
    assert [found.get_attribute("data-event") for found in chosen] == [str(GONE_AGAIN["id"])]
    assert element(opened, "#node-title").text == "Node 1: what each level holds"
    assert plan(opened, "chosen")[0] == GONE_AGAIN["outline"][0]
    low, high = opened.execute_script("return document.getElementById('plan').layout.xaxis.range")
    assert low < GONE_AGAIN["x"] < high


def click_line(driver, row, share):
    """Click into a row of the time line, at a share of its width."""
    from selenium.webdriver import ActionChains

    line = element(driver, "#line")
    driver.execute_script("arguments[0].scrollIntoView({block: 'center'})", line)
    x, y = driver.execute_script(
        "const { xaxis, yaxis } = arguments[0]._fullLayout;"
        "return [xaxis._offset + arguments[2] * xaxis._length, yaxis._offset + yaxis.d2p(arguments[1])];",
        line,
        row,
        share,
    )
    middle_x, middle_y = line.size["width"] / 2, line.size["height"] / 2
    ActionChains(driver).move_to_element_with_offset(line, x - middle_x, y - middle_y).pause(
        0.2
    ).click().perform()


@pytest.mark.parametrize("share", [0.1, 0.5, 0.9])  # at an end, in the middle and beside what is drawn
@pytest.mark.parametrize("event", [GONE_AGAIN, APPEARED])
def test_a_click_into_a_row_of_the_time_line_selects_its_change(opened, event, share):
    ids = opened.execute_script("return DATA.changes.events.map((one) => one.id)")
    click_line(opened, ids.index(event["id"]), share)
    wait(opened).until(lambda driver: driver.find_elements("css selector", "#events tr.chosen"))
    chosen = opened.find_elements("css selector", "#events tr.chosen")
    assert [found.get_attribute("data-event") for found in chosen] == [str(event["id"])]
    low, high = opened.execute_script("return document.getElementById('plan').layout.xaxis.range")
    assert low < event["x"] < high


def test_levels_are_switched_on_and_off(opened):
    assert plan(opened, "long") != []
    assert plan(opened, "short") == []
    element(opened, "#level-long").click()
    element(opened, "#level-short").click()
    assert plan(opened, "long") == []
    assert len(near(plan(opened, "short"), 1.0, 4.0)) > 0


def test_the_node_shows_all_levels_laid_over_each_other(opened):
    names = opened.execute_script(
        "return document.getElementById('node').data.map((t) => [t.name, t.x.length])"
    )
    assert names[:3] == [["long", 360], ["mid", 360], ["short", 360]]


def test_what_is_told_in_words_stands_in_the_result(opened):
    assert element(opened, "#told").text == "2 changes, of which 1 still hold; 2 nodes; 37 of 40 scans used"
    assert element(opened, "#scans").text.split() == ["read", "40", "used", "37", "no_pose", "2", "lost", "1"]
    assert HOSTILE in element(opened, "#inputs").text
    assert element(opened, "h1").text == HOSTILE
    row = element(opened, f"#events tr[data-event='{APPEARED['id']}']").text.split()
    assert row == ["3", "appeared", "1.00,", "4.00", "2023-11-14", "22:13", "short,", "mid", "100", "%"]


@pytest.mark.parametrize("width", [1280, 800])
def test_nothing_is_wider_than_its_place(opened, width):
    opened.set_window_size(width, 1000)
    wait(opened).until(lambda driver: too_wide(driver) == [])  # pictures follow the window a little later


def test_nothing_is_wrong_in_the_console(opened):
    slide(opened, 0)
    element(opened, f"#events tr[data-event='{APPEARED['id']}']").click()
    assert [line for line in opened.get_log("browser") if line["level"] == "SEVERE"] == []


def test_no_request_leaves_the_page(opened, address):
    slide(opened, 0)
    element(opened, f"#events tr[data-event='{APPEARED['id']}']").click()
    messages = [json.loads(line["message"])["message"] for line in opened.get_log("performance")]
    asked = [
        message["params"]["request"]["url"]
        for message in messages
        if message["method"] == "Network.requestWillBeSent"
    ]
    outside = [url for url in asked if url != address and not url.startswith(("data:", "blob:"))]
    assert address in asked
    assert outside == []


def test_a_page_without_changes_says_so(driver, tmp_path):
    with ResultReader(write(tmp_path / "r.mcap", [(0, all_levels(False))], report=REPORT)) as reader:
        (tmp_path / "r.html").write_text(page("r", page_data(reader)))
    opened = open_page(driver, (tmp_path / "r.html").as_uri())
    assert element(opened, "#events tbody").text == "No change was found."
    assert not element(opened, "#line-box").is_displayed()
    assert [line for line in opened.get_log("browser") if line["level"] == "SEVERE"] == []


@pytest.fixture(scope="module")
def checked_address(tmp_path_factory):
    """Address of the page of a result with a box that its baseline does not have."""
    folder = tmp_path_factory.mktemp("checked")
    write(folder / "plain.timemap.mcap", [(0, all_levels(box=False))], report=REPORT)
    write(folder / "box.timemap.mcap", [(0, all_levels(box=True))], report=REPORT)
    to, html = ("--baseline", folder / "b.yaml"), folder / "box.html"
    timemap("check", folder / "plain.timemap.mcap", *to, "--update-baseline")
    assert timemap("check", folder / "box.timemap.mcap", *to, "--html", html).code == 4
    return html.as_uri()


def test_a_checked_result_shows_the_baseline_beside_it(driver, checked_address):
    opened = open_page(driver, checked_address)
    assert "b.yaml: failed, " in opened.find_element("id", "check-title").text
    drawn = "return document.getElementById('plan').data.find((one) => one.name === 'baseline')"
    assert opened.execute_script(f"{drawn}.x.length") == 360  # the long level is ticked, at one node
    assert opened.execute_script(f"{drawn}.visible") is True
    opened.find_element("id", "baseline").click()
    assert opened.execute_script(f"{drawn}.visible") is False
    assert [one for one in opened.get_log("browser") if one["level"] == "SEVERE"] == []


def test_a_place_out_of_tolerance_is_gone_to(driver, checked_address):
    opened = open_page(driver, checked_address)
    width = "const [low, high] = document.getElementById('plan').layout.xaxis.range; return high - low"
    whole = opened.execute_script(width)
    opened.find_element("css selector", "#failures tr.placed").click()
    assert opened.execute_script(width) < whole / 2


def test_a_result_that_was_not_checked_shows_no_check(opened):
    assert not opened.find_element("id", "check-box").is_displayed()
