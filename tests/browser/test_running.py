import itertools

import pytest

from tests.app.planar_arm import csv_log, description
from veritorque.app.jobs.computation import Failed
from veritorque.app.problems import Problem

SEEDS = itertools.count()  # what was asked before is answered at once


@pytest.fixture(scope="session")
def arm(browser, staged, key):
    """A robot and a log that the guarded service knows, and what asks it for jobs of them."""
    context = browser.new_context(base_url=staged[1], extra_http_headers={"Authorization": f"Bearer {key}"})
    asking = context.request
    robot = asking.post("/v1/robots", data=description()).json()["id"]
    csv = {"Content-Type": "text/csv"}
    log = asking.post("/v1/logs?name=swing.csv", data=csv_log(seconds=4.0), headers=csv).json()["id"]
    yield asking, {"kind": "identify", "robot": robot, "logs": [log]}
    context.close()


@pytest.fixture
def held(staged, arm, key, look):
    """Open the page of a job that runs until it is let go; the executor decides how it ends."""
    _, address, executor = staged
    executor.release.clear()
    executor.started.clear()
    executor.stopped.clear()
    outcome = executor.outcome
    asking, body = arm
    job = asking.post("/v1/jobs", data=body | {"options": {"bootstrap": {"seed": next(SEEDS)}}}).json()
    seen = look(address, key=key)
    assert executor.started.wait(60.0)
    seen.open(f"/studies/{job['id']}")
    seen.page.get_by_role("progressbar").wait_for()
    yield seen, executor
    executor.release.set()
    executor.outcome = outcome


def test_a_running_study_tells_how_far_it_is_and_shows_its_end_by_itself(held):
    seen, executor = held
    page = seen.page
    page.get_by_text("Estimate, 50 %").wait_for()
    page.get_by_text("running for").wait_for()
    assert page.get_by_role("progressbar").get_attribute("value") == "0.5"
    seen.photograph("study_running_light")
    assert seen.barriers() == []
    seen.statuses.add(404)  # what is computed here has no traces
    executor.release.set()
    page.locator(".state.successful").wait_for()
    page.locator(".headline").wait_for()


def test_a_study_that_fails_says_why_and_what_to_do(held):
    seen, executor = held
    problem = Problem("excitation", "the motion is too slow", evidence={"speed": 0.01}, remedy="move faster")
    executor.outcome = Failed(problem.document())
    executor.release.set()
    alert = seen.page.get_by_role("alert")
    alert.wait_for()
    assert "The motion is too slow." in alert.text_content()
    assert "Remedy: Move faster." in alert.text_content()
    seen.photograph("study_failed_light")
    assert seen.barriers() == []


def test_a_running_study_can_be_cancelled(held):
    seen, executor = held
    seen.page.get_by_role("button", name="Cancel the study").click()
    seen.page.locator(".state.dismissed").wait_for()
    assert executor.stopped.wait(30.0)
    seen.page.get_by_text("The study was dismissed").wait_for()


def test_a_stream_that_breaks_is_taken_up_again(held):
    seen, executor = held
    seen.complaints.clear()
    seen.page.context.set_offline(True)
    seen.page.wait_for_timeout(300)
    seen.page.context.set_offline(False)
    executor.release.set()
    seen.page.locator(".state.successful").wait_for()
    seen.complaints[:] = [one for one in seen.complaints if "ERR_INTERNET_DISCONNECTED" not in one]


def test_whoever_has_no_key_is_asked_for_one_and_goes_on(look, staged, key):
    seen = look(staged[1])
    seen.statuses.add(401)
    page = seen.open("/")
    dialog = page.get_by_role("dialog", name="This service requires an API key")
    dialog.wait_for()
    seen.photograph("key_light")
    assert seen.barriers() == []
    dialog.get_by_label("Key").fill(key)
    dialog.get_by_role("button", name="Use this key").click()
    page.locator("#studies table, #studies p.soft").first.wait_for()
    assert page.get_by_role("dialog").count() == 0
    page.reload()
    page.locator("#studies table, #studies p.soft").first.wait_for()


def test_result_report_and_comparison_are_there_for_whoever_has_a_key(held):
    seen, executor = held
    page = seen.page
    seen.statuses.add(404)  # what is computed here has no traces
    executor.release.set()
    page.locator(".state.successful").wait_for()
    page.locator("#parameters").scroll_into_view_if_needed()
    page.locator("#parameters tbody tr").first.wait_for()
    with page.expect_download() as saving:
        page.get_by_role("link", name="Open the report").click()
    assert saving.value.suggested_filename == "report.html"
    assert "physically consistent" in saving.value.path().read_text(encoding="utf-8")
    again = """async (id) => {
      const { get, post } = await import("/static/base/api.js");
      const { kind, robot, logs } = await get(`/v1/jobs/${id}`);
      return post("/v1/jobs", { kind, robot, logs, options: { estimator: "ols" } });
    }"""
    first = page.url.split("/")[-1]
    second = page.evaluate(again, first)["id"]
    seen.open(f"/studies/{second}")
    page.locator(".state.successful").wait_for()
    seen.open(f"/compare?left={first}&right={second}")
    page.get_by_text("No parameter of 1 differs").wait_for()


def test_a_wrong_key_is_asked_for_again_and_none_is_a_problem(look, staged):
    seen = look(staged[1])
    seen.statuses.add(401)
    page = seen.open("/")
    dialog = page.get_by_role("dialog")
    dialog.get_by_label("Key").fill("wrong")
    dialog.get_by_role("button", name="Use this key").click()
    dialog.get_by_text("not known, or was revoked").wait_for()
    dialog.get_by_role("button", name="Cancel").click()
    page.get_by_role("alert").get_by_text("Authentication failed").wait_for()


def test_a_study_that_does_not_exist_is_said_so(look, service):
    seen = look(service)
    seen.statuses.add(404)
    page = seen.open("/studies/job-none")
    page.get_by_role("alert").get_by_text("Resource not found").wait_for()


class Keyboard:
    """Go through a page by keys alone."""

    def __init__(self, page):
        self.page = page

    def reach(self, what):
        for _ in range(80):
            self.page.keyboard.press("Tab")
            if self.page.evaluate("(what) => document.activeElement.matches(what)", what):
                return
        raise AssertionError(f"{what} is not reached by the tabulator")

    def press(self, what, key="Enter"):
        self.reach(what)
        self.page.keyboard.press(key)


def test_the_whole_path_goes_by_keys(look, staged, key, tmp_path):
    _, address, executor = staged
    executor.release.set()
    path = tmp_path / "keys.csv"
    path.write_bytes(csv_log(seconds=4.0))
    seen = look(address, key=key)
    seen.statuses.add(404)  # what is computed here has no traces
    page = seen.open("/")
    keyboard = Keyboard(page)
    keyboard.press("nav a[href='/new']")
    page.wait_for_url("**/new")
    keyboard.press("input[type=radio][value=list]", "ArrowRight")
    keyboard.press("button[aria-label='Remove joint 3']")
    keyboard.press("#robot button.primary")
    page.locator(".chosen").wait_for()
    keyboard.reach("#log input[type=file]")
    page.set_input_files("#log input[type=file]", path)  # the window of files is the system's own
    page.locator(".plot").nth(3).wait_for()
    keyboard.press("input[name=question]", "ArrowDown")
    keyboard.press("#question button.primary")
    page.wait_for_url("**/studies/*")
    page.locator(".state.successful").wait_for()
    keyboard.reach("a[href$='/report']")


def test_an_address_that_is_no_text_leads_to_an_answer(look, service):
    seen = look(service)
    seen.statuses |= {400, 404, 422}
    seen.open("/studies/%E0%A4%A").get_by_role("alert").wait_for()


def test_a_study_that_was_deleted_meanwhile_leaves_the_list(held):
    seen, _ = held
    seen.statuses.add(404)
    page = seen.page
    job = page.url.split("/")[-1]
    page.goto(seen.address)
    link = page.locator(f"th a[href='/studies/{job}']")
    link.wait_for()
    page.route(
        f"**/v1/jobs/{job}", lambda route: route.fulfill(status=404, json={"title": "gone", "status": 404})
    )
    link.wait_for(state="detached")
