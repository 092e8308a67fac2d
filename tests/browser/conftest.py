import shutil

import pytest

from tests.app.stubs import StubExecutor
from tests.browser.services import serving
from tests.browser.watch import Watched
from tests.browser.windows import Windows
from veritorque.app.store.keys import KeyStore

BROWSERS = ("chromium", "chromium-browser", "google-chrome")
FLAGS = (
    "--no-sandbox",  # it cannot make one of its own inside most containers, and sees nothing but our pages
    "--disable-gpu",  # an emulated one draws slower than none, and Debian would use it
    "--disable-gpu-rasterization",
)


@pytest.fixture(scope="session")
def browser():
    found = next(filter(None, map(shutil.which, BROWSERS)), None)
    if found is None:
        pytest.skip(f"NO BROWSER: none of {', '.join(BROWSERS)} is installed, so no page was looked at")
    playwright = pytest.importorskip("playwright.sync_api", reason="NO PLAYWRIGHT: no page was looked at")
    with playwright.sync_playwright() as driver:
        started = driver.chromium.launch(executable_path=found, args=FLAGS)
        yield started
        started.close()


@pytest.fixture(scope="session")
def service(tmp_path_factory):
    """The service as people start it: address only."""
    with serving(tmp_path_factory.mktemp("service")) as (_, address):
        yield address


@pytest.fixture(scope="session")
def staged(tmp_path_factory):
    """A service that asks for keys, and whose jobs end when told to: application, address, executor."""
    executor = StubExecutor()
    with serving(tmp_path_factory.mktemp("staged"), executor=executor, guarded=True) as (app, address):
        yield app, address, executor
        executor.release.set()


@pytest.fixture(scope="session")
def key(staged):
    _, secret = KeyStore(staged[0].state.services.store.database).create(
        tenant="lab", name="lab", scopes=("read", "write")
    )
    staged[0].state.services.keys._until = 0.0  # as if the seconds had passed
    return secret


@pytest.fixture(scope="session")
def studied(browser, service):
    """The address of a finished study of the example, made by one click on the start page."""
    page = browser.new_page()
    page.goto(service)
    page.get_by_role("button", name="Identify the arm").click(timeout=120_000)
    page.wait_for_url("**/studies/*", timeout=120_000)
    page.locator(".state.successful").wait_for(timeout=180_000)
    address = page.url
    page.close()
    return address


@pytest.fixture(scope="session")
def windows(browser):
    """Windows that tests are done with: to open another costs a second and a half of a processor."""
    kept = Windows(browser)
    yield kept
    kept.close()


@pytest.fixture
def look(windows):
    """Show pages in a window each; at the end none may have complained or called anybody else.

    Nothing is stored in a window when a test is given it. What is to be loaded as for the first time asks for
    a new one, with an empty cache.
    """
    opened = []

    def at(address, *, width=1200, height=900, scheme="light", key=None, new=False):
        shape = {"viewport": {"width": width, "height": height}, "color_scheme": scheme}
        page = windows.give(address, shape, key, new=new)
        watched = Watched(page, address)
        opened.append(watched)
        return watched

    yield at
    complaints = [one for watched in opened for one in watched.complaints]
    elsewhere = [url for watched in opened for url in watched.elsewhere]
    for watched in opened:
        watched.stop()
        windows.take_back(watched.page, watched.address)
    assert complaints == []
    assert elsewhere == []
