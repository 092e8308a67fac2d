import re
from pathlib import Path

import pytest

from tests.browser.test_burden import LOOKS

LOG = Path(__file__).parents[2] / "examples" / "yumi" / "log.csv"
MOST_CLICKS = 8


class Finger:
    """Count what is clicked, chosen and dropped: each of them is one click of a person at least."""

    def __init__(self, page):
        self.page, self.clicks = page, 0

    def click(self, role, name):
        self.clicks += 1
        self.page.get_by_role(role, name=name).first.click()

    def choose(self, label, value):
        self.clicks += 2  # opens the menu, takes the entry
        self.page.get_by_label(label, exact=True).select_option(value)

    def give(self, selector, file):
        self.clicks += 2  # opens the window, takes the file
        self.page.set_input_files(selector, file)


def test_from_the_start_page_to_the_report_of_a_log_of_ones_own(look, service, studied):
    seen = look(service)
    page, finger = seen.open("/"), Finger(seen.page)
    finger.click("link", "New study")
    finger.choose("Robot", "yumi-left")
    finger.give("#log input[type=file]", LOG)
    page.locator(".plot").nth(13).wait_for()
    page.get_by_text("No defects found").or_(page.get_by_text("found, marked in the plots")).wait_for()
    seen.photograph("new_light")
    finger.click("button", "Start")
    page.locator(".state.successful").wait_for()
    assert re.search(r"/studies/job-\w+$", page.url)
    assert finger.clicks + 1 <= MOST_CLICKS
    report = page.locator("a[href$='/report']").first.get_attribute("href")
    page.goto(service + report)
    assert "yumi-left" in page.text_content("body")


def test_the_list_of_studies_leads_to_each(look, service, studied):
    seen = look(service)
    page = seen.open("/")
    link = page.locator(f"a[href$='{studied.removeprefix(service)}']").first
    link.wait_for()
    assert "Identification of yumi-left" in link.text_content()
    assert page.locator(".state.successful").count() >= 1
    link.click()
    page.locator(".state.successful").wait_for()
    page.get_by_role("heading", level=1, name="Identification of yumi-left from log.csv").wait_for()


@pytest.mark.parametrize("name", LOOKS)
def test_the_start_page_fits_every_window(look, service, studied, name):
    seen = look(service, **LOOKS[name])
    page = seen.open("/")
    page.locator(".state.successful").first.wait_for()
    seen.photograph(f"start_{name}")
    assert page.evaluate("document.documentElement.scrollWidth <= innerWidth")
    assert seen.barriers() == []


def test_the_theme_can_be_chosen_and_is_kept(look, service):
    page = look(service, scheme="light").open("/")
    page.get_by_role("button", name="Switch to the dark theme").click()
    page.reload()
    assert page.evaluate("document.documentElement.dataset.theme") == "dark"
