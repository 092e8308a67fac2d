"""Watch a page: every request it makes, every complaint of the browser, everything axe finds."""

import os
import re
from pathlib import Path

AXE = Path(__file__).parent / "vendor" / "axe-core" / "axe.min.js"
SCREENSHOTS = Path(__file__).parent / "screenshots"
FAILED_LOAD = re.compile(r"Failed to load resource: the server responded with a status of (\d+)")


class Watched:
    """A page whose doings are written down. `statuses` are failures that a test brings about on purpose."""

    def __init__(self, page, address):
        self.page, self.address = page, address
        self.requests, self.complaints, self.statuses = [], [], set()
        self._heard = {"request": self._note, "pageerror": self._complain, "console": self._hear}
        for event, hear in self._heard.items():
            page.on(event, hear)

    def stop(self):
        """Listen no more: the next test looks at this page, too."""
        for event, hear in self._heard.items():
            self.page.remove_listener(event, hear)

    def _note(self, request):
        self.requests.append(request.url)

    def _complain(self, error):
        self.complaints.append(str(error))

    def _hear(self, message):
        failed = FAILED_LOAD.match(message.text)
        if message.type in {"error", "warning"} and not (failed and int(failed[1]) in self.statuses):
            self.complaints.append(f"{message.text} {message.location.get('url', '')}")

    @property
    def elsewhere(self):
        ours = (self.address, "data:", "blob:" + self.address)
        return [url for url in self.requests if not url.startswith(ours)]

    def open(self, path):
        self.page.goto(self.address + path)
        self.page.wait_for_load_state("load")
        return self.page

    def photograph(self, name):
        """Keep a picture to be looked at, where somebody means to: it is drawn without a graphics card."""
        if "PICTURES" not in os.environ:
            return
        SCREENSHOTS.mkdir(exist_ok=True)
        self.page.screenshot(path=SCREENSHOTS / f"{name}.png", full_page=True)

    def barriers(self):
        """Give what axe calls serious or critical: rule, and the first element that breaks it."""
        self.page.evaluate(AXE.read_text(encoding="utf-8"))
        found = self.page.evaluate("axe.run({resultTypes: ['violations']})")["violations"]
        return [
            (one["id"], one["nodes"][0]["html"][:200], one["nodes"][0]["failureSummary"])
            for one in found
            if one["impact"] in {"serious", "critical"}
        ]
