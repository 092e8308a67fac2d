"""The page of a result says what the result says, can be steered, and fits every window."""

import csv
import io
import json
from pathlib import Path

import pytest

from tests.app.planar_arm import csv_log, description
from tests.browser.test_burden import LARGEST_PAGE, LOOKS

HIDDEN_LOG = Path(__file__).parents[2] / "examples" / "yumi" / "hidden_log.csv"
LOG = HIDDEN_LOG.with_name("log.csv")
REVERSED_SAMPLES = 2000
QUICK = {"bootstrap": {"draws": 0}}
COMPARED = {"compare": ["ols", "sdp", "iv"], "simulation": {"bandwidth_hz": 100.0, "substeps": 1}}
"""Few estimators have every part of the page; that all are compared by default is tested where they are."""
SAMPLES = 3750
"""The first quarter of a minute tells both things that are hidden, and is diagnosed in less time."""
COMMON = ["torque", "parameters", "residuals", "bodies", "excitation", "motion", "export"]
DIAGNOSED = ["findings", "remainder", *COMMON]


@pytest.fixture(scope="session")
def diagnosed(browser, service):
    """The address of a finished diagnosis of half of the example in which something is hidden."""
    page = browser.new_page()
    asking = page.request
    log = asking.post(
        f"{service}/v1/logs?name=hidden_log.csv",
        data=b"\n".join(HIDDEN_LOG.read_bytes().splitlines()[: 1 + SAMPLES]),
        headers={"Content-Type": "text/csv"},
        timeout=120_000,
    ).json()["id"]
    job = asking.post(
        f"{service}/v1/jobs",
        data={"kind": "diagnose", "robot": "yumi-left", "logs": [log]},
        headers={"Prefer": "wait=60"},
        timeout=120_000,
    ).json()["id"]
    page.goto(f"{service}/studies/{job}")
    page.locator(".headline").wait_for(timeout=180_000)
    address = page.url
    page.close()
    return address


@pytest.fixture(scope="session")
def reversed_log(browser, service):
    """The id of a log of the example's beginning, in which torque 2 was recorded reversed."""
    head, *rows = [line.split(",") for line in LOG.read_text().splitlines()[: 1 + REVERSED_SAMPLES]]
    torque = head.index("tau_2")
    for row in rows:
        row[torque] = str(-float(row[torque]))
    page = browser.new_page()
    log = page.request.post(
        f"{service}/v1/logs?name=reversed.csv",
        data="\n".join(",".join(row) for row in (head, *rows)),
        headers={"Content-Type": "text/csv"},
        timeout=120_000,
    ).json()["id"]
    page.close()
    return log


def started(page, service, kind, log, **options):
    """Start a study of a log, and open its page when it is finished."""
    body = {"kind": kind, "robot": "yumi-left", "logs": [log], "options": QUICK | options}
    job = page.request.post(f"{service}/v1/jobs", data=body, timeout=120_000).json()["id"]
    page.goto(f"{service}/studies/{job}")
    page.locator(".headline").wait_for(timeout=180_000)
    return page.url


def test_a_conflict_is_applied_by_a_click_and_the_new_study_has_none(look, service, reversed_log):
    page = look(service).page
    first = started(page, service, "identify", reversed_log)
    card = page.locator(".conflict")
    before = document_of(page)
    assert card.locator("h2").inner_text().startswith("Robot and log disagree: reverse the sign of")
    card.locator("summary").click()
    (conflict,) = before["conflicts"]
    shown = json.loads(card.locator("pre").inner_text())
    assert shown == {"mapping": conflict["correction"]["mapping"]}
    page.get_by_role("button", name="Apply and start again").click()
    page.wait_for_url(lambda address: address != first)
    page.locator(".headline").wait_for(timeout=180_000)
    after = document_of(page)
    assert (after["conflicts"], page.locator(".conflict").count()) == ([], 0)
    assert after["base_parameters"] == before["base_parameters"]


def test_a_set_up_check_has_a_page_of_its_own_without_barriers(look, service, reversed_log):
    seen = look(service, width=390, height=800)
    started(seen.page, service, "check", reversed_log)
    page = drawn(seen.page, ["errors", "parameters", "causes"])
    document = document_of(page)
    assert "belong together once they are corrected" in page.locator(".headline").inner_text()
    assert page.locator("#parameters .chips li").count() == document["counts"]["base"]
    assert page.locator("#causes tbody tr").count() == len(document["shown"])
    assert page.locator("#causes .content > ul > li").count() == len(document["not_separable"])
    assert page.evaluate("document.documentElement.scrollWidth <= innerWidth")
    seen.photograph("result_check_phone")
    assert seen.barriers() == []


def test_a_comparison_of_estimators_has_a_page_of_its_own_without_barriers(look, service, reversed_log):
    seen = look(service, width=390, height=800)
    started(seen.page, service, "compare", reversed_log, **COMPARED)
    page = drawn(seen.page, ["estimators", "parameters", "export"])
    document = document_of(page)
    assert page.locator("#estimators tbody tr").count() == len(document["compared"])
    assert page.locator("#parameters tbody tr").count() == len(document["parameters"])
    assert page.locator("#export a").count() == 3
    assert page.evaluate("document.documentElement.scrollWidth <= innerWidth")
    seen.photograph("result_compare_phone")
    assert seen.barriers() == []


def drawn(page, sections):
    """Scroll through the sections, until each is drawn."""
    page.locator(".headline").wait_for()
    for section in sections:
        page.locator(f"#{section}").scroll_into_view_if_needed()
        page.locator(f"#{section}[data-drawn]").wait_for()
    page.evaluate("scrollTo(0, 0)")
    return page


def document_of(page):
    """Read the result that the page shows, past the page."""
    job = page.url.rstrip("/").split("/")[-1]
    origin = page.url.split("/studies/")[0]
    return page.request.get(f"{origin}/v1/jobs/{job}/results").json()


@pytest.mark.parametrize(
    ("kind", "name"),
    [("identify", "light"), ("identify", "dark_phone"), ("diagnose", "light"), ("diagnose", "dark_phone")],
)
def test_a_result_is_whole_and_has_no_barriers_in_any_window(look, service, studied, diagnosed, kind, name):
    address, sections = (studied, COMMON) if kind == "identify" else (diagnosed, DIAGNOSED)
    seen = look(service, **LOOKS[name], new=True)
    sizes = []
    seen.page.on("requestfinished", lambda request: sizes.append(request.sizes()["responseBodySize"]))
    page = drawn(seen.open(address.removeprefix(service)), sections)
    assert page.locator(".problem").count() == 0
    assert page.locator("#torque .plot").count() == 7
    assert page.evaluate("document.documentElement.scrollWidth <= innerWidth")
    assert sum(sizes) <= LARGEST_PAGE
    seen.photograph(f"result_{kind}_{name}")
    assert seen.barriers() == []


def test_a_result_is_there_within_a_second(look, service, studied):
    """Of the time that its page computes until the first screen stands: a busy machine would add its own."""
    page = look(service, new=True).page
    watching = page.context.new_cdp_session(page)
    watching.send("Performance.enable", {"timeDomain": "threadTicks"})
    page.goto(studied)
    page.locator(".headline").wait_for()
    metrics = {one["name"]: one["value"] for one in watching.send("Performance.getMetrics")["metrics"]}
    assert 0.0 < metrics["TaskDuration"] <= 1.0
    assert page.evaluate("performance.getEntriesByType('navigation')[0].responseEnd / 1000") <= 1.0


def test_the_first_screen_says_what_came_out(look, service, studied):
    page = drawn(look(service).open(studied.removeprefix(service)), [])
    document = document_of(page)
    told = page.locator(".headline").inner_text()
    assert f"{document['counts']['essential']} of {document['counts']['base']}" in told
    assert f"{document['validation_total_percent']:.3g}" in told
    assert "held-out data, RMS of residual over RMS of torque" in told
    assert "Physically consistent" in told
    assert "yumi-left: identification" not in told  # the page's own heading says so
    assert " (joint " in told
    of_one_joint = page.evaluate(
        """async (result) => {
          const { showHeadline } = await import("/static/result/headline.js");
          const place = document.createElement("div");
          const report = new DOMParser().parseFromString("<p></p>", "text/html");
          showHeadline(place, { job: { links: { report: "/" } }, document: result, report });
          return place.textContent;
        }""",
        document | {"validation": document["validation"][:1]},
    )
    assert "RMS of residual over RMS of torque" in of_one_joint
    assert "(joint 1)" not in of_one_joint


def test_findings_are_told_with_their_figures_as_the_report_tells_them(look, service, diagnosed):
    page = drawn(look(service).open(diagnosed.removeprefix(service)), ["findings"])
    findings = document_of(page)["diagnosis"]["findings"]
    cards = page.locator("#findings .finding")
    assert cards.count() == len(findings) == 2
    for place, finding in enumerate(findings):
        told = cards.nth(place).inner_text()
        assert finding["statement"].split(" ")[0] in told
        assert "confidence in this cause" in told
        assert cards.nth(place).locator("svg").count() == 2


class Table:
    """The table of parameters, as it stands."""

    def __init__(self, page):
        self.page = page

    @property
    def names(self):
        return self.page.locator("#parameters tbody th").all_inner_texts()


def test_parameters_are_sorted_filtered_and_copied(look, service, studied):
    seen = look(service)
    page = drawn(seen.open(studied.removeprefix(service)), ["parameters"])
    page.context.grant_permissions(["clipboard-read", "clipboard-write"])
    document, table = document_of(page), Table(page)
    rows = {row["name"]: row for row in document["base_parameters"]}
    assert table.names == list(rows)

    by_percent = sorted(rows, key=lambda name: rows[name]["relative_deviation_percent"])
    page.locator("#parameters").get_by_role("button", name="%P").click()
    assert table.names == by_percent
    page.locator("#parameters").get_by_role("button", name="%P").press("Enter")
    assert table.names == by_percent[::-1]
    assert page.locator("#parameters th[aria-sort=descending]").inner_text().startswith("%P")

    page.get_by_label("Show", exact=True).select_option("3")
    wanted = [name for name in by_percent[::-1] if rows[name]["joint"] == 3]
    assert table.names == wanted
    page.get_by_role("button", name="Copy as CSV").click()
    page.get_by_text("Copied").wait_for()
    copied = list(csv.DictReader(io.StringIO(page.evaluate("navigator.clipboard.readText()"))))
    assert [(row["name"], float(row["value"])) for row in copied] == [
        (name, rows[name]["value"]) for name in wanted
    ]


def test_latex_is_saved_with_one_line_per_parameter(look, service, studied):
    page = drawn(look(service).open(studied.removeprefix(service)), ["parameters"])
    with page.expect_download() as saving:
        page.get_by_role("button", name="Save as LaTeX").click()
    text = Path(saving.value.path()).read_text()
    assert text.count(r"\\") == 1 + document_of(page)["counts"]["base"]


def test_who_looks_closer_is_shown_finer_traces_of_that_stretch(look, service, studied):
    """The example is short enough to be shown whole, so its answers are told to be thinned."""
    seen = look(service)
    page = seen.page

    def thinned(route):
        answer = route.fetch()
        route.fulfill(response=answer, json=answer.json() | {"rows_per_stretch": 8})

    def asked(of, *, finer):
        traces = [url for url in seen.requests if f"/v1/{of}/" in url and "/traces?" in url]
        return len([url for url in traces if ("from=" in url) == finer])

    page.route("**/v1/*/*/traces?*", thinned)
    page.goto(studied)
    with page.expect_response("**/v1/logs/*/traces?*"):
        drawn(page, ["torque"])
    assert (asked("jobs", finer=False), asked("logs", finer=False)) == (7, 1)
    assert (asked("jobs", finer=True), asked("logs", finer=True)) == (0, 0)
    with (
        page.expect_response(lambda answer: "/v1/logs/" in answer.url and "from=" in answer.url),
        page.expect_response(lambda answer: "/v1/jobs/" in answer.url and "from=" in answer.url),
    ):
        page.locator("#torque .canvas").nth(2).press("+")
    page.get_by_role("button", name="Whole range").first.wait_for()
    assert asked("logs", finer=True) == 1  # of all joints together
    page.unroute_all(behavior="ignoreErrors")


def test_the_residual_of_another_joint_is_a_click_away(look, service, studied):
    page = drawn(look(service).open(studied.removeprefix(service)), ["residuals"])
    buttons = page.locator("#residuals").get_by_role("button", name="Joint 4")
    buttons.first.click()
    page.get_by_text("Joint 4 over frequency").first.wait_for()
    assert page.locator("#residuals .plot").count() == 4
    assert page.locator("#residuals button[aria-pressed=true]").inner_text() == "Joint 4"


def test_every_body_is_drawn_and_can_be_turned_by_keys(look, service, studied):
    page = drawn(look(service).open(studied.removeprefix(service)), ["bodies"])
    assert page.get_by_text("configurations of the workspace, in kg m²").count() == 1
    assert page.get_by_text("only its sign matters").count() == 1
    ellipses = page.locator("#bodies ellipse.body")
    assert ellipses.count() == len(document_of(page)["bodies"]) == 7
    before = ellipses.nth(2).get_attribute("transform")
    page.locator("#bodies .stage3d").press("ArrowLeft")
    assert ellipses.nth(2).get_attribute("transform") != before


def test_every_file_that_is_offered_is_there(look, service, studied):
    page = drawn(look(service).open(studied.removeprefix(service)), ["export"])
    offered = [link.get_attribute("href") for link in page.locator("#export .files a").all()]
    assert len(offered) == len(set(offered)) >= 12
    assert {path: page.request.get(service + path).status for path in offered} == dict.fromkeys(offered, 200)


def test_an_audit_is_read_by_all_and_fits_a_phone(look, service):
    body = {"mass": 0.2, "center_of_mass": [0.2, 0.0, 0.0], "inertia_at_com": [0.01, 0, 0, 0.02, 0, 0.02]}
    seen = look(service, width=390, height=844)
    asking = seen.page.request

    def made(path, data, kind="application/json"):
        answer = asking.post(f"{service}{path}", data=data, headers={"Content-Type": kind}, timeout=120_000)
        return answer.json()["id"]

    robot = made("/v1/robots", description() | {"prior": [body, body]})
    log = made("/v1/logs", csv_log(seconds=12.0, noise=0.05), "text/csv")
    page = seen.open(f"/studies/{made('/v1/jobs', {'kind': 'audit', 'robot': robot, 'logs': [log]})}")
    page.locator(".state.successful").wait_for()
    page.get_by_text("corrected for the number of entries").first.wait_for()
    assert page.get_by_role("button", name="Apply and start again").is_visible()
    assert page.evaluate("document.documentElement.scrollWidth") == 390
    assert seen.barriers() == []
