"""Keep windows of the browser from one test for the next, which finds nothing that the one before left."""

import json

PATIENCE_MS = 120_000  # of a machine that is busy otherwise
PICTURE = "/static/mark.svg"
"""What may store anything, and stores nothing; a report may not."""
CLEAR = "sessionStorage.clear(); localStorage.clear()"


class Windows:
    """Windows without a test, by the service, shape and key that they were opened for."""

    def __init__(self, browser):
        self.browser, self.free, self.lent = browser, {}, {}

    def give(self, address, shape, key, *, new):
        """Give a page in a window of its own, which is on no page yet."""
        wanted = None if new else json.dumps([address, shape, key])
        page = self.free.pop(wanted, None) or self._opened(shape, key)
        self.lent[page] = wanted
        return page

    def take_back(self, page, address):
        """Keep a window that is not new, cleared of what its pages have stored."""
        wanted = self.lent.pop(page)
        if wanted is None or wanted in self.free:
            page.context.close()
            return
        page.unroute_all(behavior="ignoreErrors")
        page.goto(address + PICTURE)
        page.evaluate(CLEAR)
        page.goto("about:blank")
        page.context.clear_cookies()
        page.context.clear_permissions()
        self.free[wanted] = page

    def close(self):
        """Close what is left."""
        for page in self.free.values():
            page.context.close()

    def _opened(self, shape, key):
        context = self.browser.new_context(**shape, reduced_motion="reduce")
        context.set_default_timeout(PATIENCE_MS)
        if key is not None:
            context.add_init_script(f"sessionStorage.setItem('veritorque-key', '{key}')")
        return context.new_page()
