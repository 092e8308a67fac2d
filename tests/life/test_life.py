"""The short forms; `make life` runs the long ones."""

from hypothesis import settings

from tests.life.machine import JobLives
from tests.life.tenants import Tenants

TestJobLives = JobLives.TestCase
TestJobLives.settings = settings(max_examples=20, stateful_step_count=30)


def test_tenants_never_see_anything_of_each_other(tmp_path):
    with Tenants(tmp_path, seed=2) as tenants:
        while tenants.operations < 250:
            tenants.act()
    assert tenants.crossed > 40
    assert tenants.leaks == 0


def test_a_leak_would_be_noticed(tmp_path, monkeypatch):
    with Tenants(tmp_path, seed=2) as tenants:
        opened = tenants._client.app.state.services.store
        of = type(opened).of
        monkeypatch.setattr(type(opened), "of", lambda store, tenant: of(store, "everybody"))
        while tenants.operations < 60:
            tenants.act()
    assert tenants.leaks > 0
