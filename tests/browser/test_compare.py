"""Two studies side by side: chosen, judged by standard deviations, and laid over each other."""

import math

import pytest

from tests.browser.test_burden import LOOKS
from tests.browser.test_result import diagnosed  # noqa: F401  (a fixture of both)


def job_of(address):
    return address.rstrip("/").split("/")[-1]


def document_of(page, service, job):
    return page.request.get(f"{service}/v1/jobs/{job}/results").json()


@pytest.fixture(scope="session")
def pair(studied, diagnosed):  # noqa: F811  (a fixture of both)
    return job_of(studied), job_of(diagnosed)


@pytest.fixture(scope="session")
def again(browser, service, studied):
    """Another identification from the log of the first."""
    page = browser.new_page()
    first = page.request.get(f"{service}/v1/jobs/{job_of(studied)}").json()
    body = {name: first[name] for name in ("kind", "robot", "logs")} | {"options": {"estimator": "ols"}}
    job = page.request.post(
        f"{service}/v1/jobs", data=body, headers={"Prefer": "wait=60"}, timeout=120_000
    ).json()
    page.close()
    assert job["state"] == "successful"
    return job["id"]


@pytest.mark.parametrize("name", LOOKS)
def test_two_studies_are_compared_in_any_window_without_barriers(look, service, pair, name):
    seen = look(service, **LOOKS[name])
    page = seen.open(f"/compare?left={pair[0]}&right={pair[1]}")
    page.locator(".compared").wait_for()
    seen.photograph(f"compare_{name}")
    assert page.get_by_text("different logs").count() == 1
    assert page.evaluate("document.documentElement.scrollWidth <= innerWidth")
    assert seen.barriers() == []


def test_parameters_differ_by_standard_deviations_of_the_difference(look, service, pair):
    page = look(service).open(f"/compare?left={pair[0]}&right={pair[1]}")
    page.locator(".compared").wait_for()
    left, right = (
        {row["name"]: row for row in document_of(page, service, job)["base_parameters"]} for job in pair
    )

    def z(name):
        spread = math.hypot(left[name]["standard_deviation"], right[name]["standard_deviation"])
        return (right[name]["value"] - left[name]["value"]) / spread

    shown = page.locator("section[aria-labelledby=parameters] tbody tr")
    names = [name.split()[0] for name in shown.locator("th").all_inner_texts()]
    assert names == sorted(left, key=lambda name: -abs(z(name)))
    said = float(shown.first.locator("td").nth(3).inner_text().replace("−", "-"))  # noqa: RUF001  (as it is shown)
    assert said == pytest.approx(z(names[0]), rel=0.05)  # two digits are shown
    real = sum(abs(z(name)) > 3.0 for name in left)
    assert page.locator(".compared .verdict").inner_text().startswith(str(real) if real else "No parameter")


def test_what_was_asked_differently_is_marked(look, service, pair):
    page = look(service).open(f"/compare?left={pair[0]}&right={pair[1]}")
    page.locator(".compared").wait_for()
    marked = page.locator("section[aria-labelledby=settings] tr.differs th").all_inner_texts()
    assert {"Logs", "Kind"} <= set(marked)
    assert "Robot" not in marked
    only_right = page.locator("section[aria-labelledby=findings] tbody tr").all_inner_texts()
    assert len(only_right) == 2
    assert all("not diagnosed" in row and "right only" in row for row in only_right)


def test_studies_without_a_common_parameter_are_said_to_have_none_and_why(look, service, pair):
    page = look(service).page

    def renamed(route):
        document = route.fetch().json()
        rows = [row | {"name": f"other {row['name']}"} for row in document["base_parameters"]]
        route.fulfill(json=document | {"base_parameters": rows})

    page.route(f"**/v1/jobs/{pair[1]}/results", renamed)
    page.goto(f"{service}/compare?left={pair[0]}&right={pair[1]}")
    page.get_by_text("No common parameters: both studies are of the same robot").wait_for()
    assert page.locator("section[aria-labelledby=parameters] table").count() == 0


def test_the_torque_of_one_log_is_laid_over_itself_by_both_models(look, service, studied, again):
    page = look(service).open(f"/compare?left={job_of(studied)}&right={again}")
    page.locator("section[aria-labelledby=estimated-torque]").scroll_into_view_if_needed()
    page.locator("section[aria-labelledby=estimated-torque] .plot").nth(6).wait_for()
    assert page.get_by_text("Both studies used the same log").count() == 1


def test_another_study_is_chosen_and_the_address_tells_which(look, service, pair, again):
    page = look(service).open(f"/compare?left={pair[0]}&right={pair[0]}")
    page.get_by_text("Left and right are the same study").wait_for()
    page.get_by_label("Right study").select_option(again)
    page.locator(".compared").wait_for()
    assert page.url.endswith(f"left={pair[0]}&right={again}")
    page.get_by_role("button", name="Swap").click()
    page.locator(".compared").wait_for()
    assert page.url.endswith(f"left={again}&right={pair[0]}")


def test_a_study_that_cannot_be_compared_is_said_so(look, service, pair):
    page = look(service).open(f"/compare?left=0a1b2c3d-of-nothing&right={pair[1]}")
    page.get_by_text("has no parameters to compare").wait_for()
    page.locator(".compared").wait_for()
    assert "0a1b2c3d" not in page.url
