import pytest

LONGEST_LOAD_S = 1.0
LARGEST_PAGE = 2_000_000
TRIES = 5
PAGES = ["/", "/new", "/compare", "/docs"]
LOOKS = {"light": {}, "dark_phone": {"scheme": "dark", "width": 390, "height": 800}}
"""Both colours and both widths; no rule of a style asks for both."""


@pytest.mark.parametrize("path", PAGES)
def test_a_page_is_there_within_a_second_and_two_megabytes(look, service, path):
    seen = look(service, new=True)
    sizes = []
    seen.page.on("requestfinished", lambda request: sizes.append(request.sizes()["responseBodySize"]))
    times = []
    while len(times) < TRIES and (not times or min(times) > LONGEST_LOAD_S):  # the machine may be busy once
        seen.open(path)
        times.append(seen.page.evaluate("performance.getEntriesByType('navigation')[0].loadEventEnd / 1000"))
        if len(times) == 1:
            seen.page.wait_for_load_state("networkidle")
            first = sum(sizes)
    assert min(times) <= LONGEST_LOAD_S
    assert 1_000 < first <= LARGEST_PAGE


@pytest.mark.parametrize("name", LOOKS)
def test_the_new_study_page_with_all_that_it_can_show_has_no_barriers(look, service, studied, name):
    seen = look(service, **LOOKS[name])
    log = seen.open("/").evaluate("async () => (await (await fetch('/v1/logs')).json()).logs[0].id")
    page = seen.open(f"/new?robot=yumi-left&log={log}")
    page.locator(".plot").nth(3).wait_for()
    page.get_by_text("Options", exact=True).click()
    page.get_by_role("radio", name="Diagnosis").check()
    page.locator(".stage3d .joint").first.wait_for()
    seen.photograph(f"new_options_{name}")
    assert seen.barriers() == []
    assert page.evaluate("document.documentElement.scrollWidth <= innerWidth")


def test_the_table_of_a_known_robot_has_no_barriers(look, service):
    seen = look(service, **LOOKS["dark_phone"])
    page = seen.open("/new")
    page.get_by_role("radio", name="DH table").check()
    page.get_by_label("Start from").select_option("yumi-left")
    page.get_by_label("Joint 7: alpha, deg", exact=True).wait_for()
    page.get_by_label("more columns").check()
    page.get_by_label("Joint 7: gear ratio").wait_for()
    seen.photograph("new_table_dark_phone")
    assert seen.barriers() == []
    assert page.evaluate("document.documentElement.scrollWidth <= innerWidth")
