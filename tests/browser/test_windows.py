"""A window that another test has used is as good as new."""

STORED = "[sessionStorage.length, localStorage.length]"
STORE = "sessionStorage.setItem('veritorque-key', 'k'); localStorage.setItem('veritorque-theme', 'dark')"


def test_nothing_is_left_in_a_window_of_what_a_test_did_in_it(windows, service):
    shape = {"viewport": {"width": 640, "height": 480}}
    heard = []
    first = windows.give(service, shape, None, new=False)
    first.route("**/v1/**", lambda route: heard.append(route.request.url) or route.abort())
    first.goto(f"{service}/docs")
    first.evaluate(STORE)
    assert first.evaluate(STORED) == [1, 1]
    windows.take_back(first, service)
    heard.clear()
    other = windows.give(service, shape, None, new=True)
    again = windows.give(service, shape, None, new=False)
    assert (again, again.url) == (first, "about:blank")
    assert other != first
    again.goto(f"{service}/static/mark.svg")
    assert again.evaluate(STORED) == [0, 0]
    again.goto(f"{service}/v1/robots")
    assert heard == []
    for page in (other, again):
        windows.take_back(page, service)
