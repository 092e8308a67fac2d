"""A job is computed by one worker at a time, and whoever lost it has no say any more."""

from concurrent.futures import ThreadPoolExecutor

import pytest

from tests.app.stubs import add_job
from veritorque.app.store.records import JobRequestRecord
from veritorque.app.store.work import MOST_ATTEMPTS

MINE, OTHER = "worker-1", "worker-2"
PROBLEM = {"cause": "crashed"}


def asked(store, number=0, tenant="local"):
    return add_job(store.of(tenant).jobs, JobRequestRecord("identify", "arm", (), {"number": number}))


def claimed(store, owner=MINE, most=9):
    return store.work.claim(owner, most_per_tenant=most)


def held(job):
    return job.id, job.token


def now(store, job):
    return store.of(job.tenant).jobs.get(job.id)


def test_jobs_are_taken_in_the_order_in_which_they_were_asked_for_and_once_each(store):
    ids = [asked(store, number).id for number in range(3)]
    assert [one and one.id for one in (claimed(store) for _ in range(4))] == [*ids, None]


def test_many_workers_at_once_never_take_the_same_job(store):
    ids = {asked(store, number).id for number in range(24)}

    def work(number):
        return [one.id for one in iter(lambda: claimed(store, f"worker-{number}", 99), None)]

    with ThreadPoolExecutor(6) as pool:
        taken = [identity for part in pool.map(work, range(6)) for identity in part]
    assert sorted(taken) == sorted(ids)


def test_a_tenant_runs_no_more_jobs_at_once_than_its_share(store):
    for number in range(3):
        asked(store, number, "one")
    late = asked(store, 9, "two")
    first = claimed(store, most=1)
    assert claimed(store, most=1).id == late.id
    assert claimed(store, most=1) is None
    store.work.succeed(held(first), result_sha256="ab", result_bytes=2)
    assert claimed(store, most=1).tenant == "one"


@pytest.mark.parametrize("change", ["report", "succeed", "fail", "hand_back", "retry_or_fail"])
def test_who_held_a_job_before_it_was_taken_again_changes_nothing(store, change):
    job = asked(store)
    first = claimed(store)
    assert store.work.retry_or_fail(held(first), PROBLEM)
    second = claimed(store, OTHER)
    assert (second.id, second.token) == (job.id, first.token + 1)
    before = now(store, job)
    arguments = {
        "report": {"stage": "late", "fraction": 0.9},
        "succeed": {"result_sha256": "ab", "result_bytes": 2},
        "fail": {"problem": PROBLEM},
        "retry_or_fail": {"problem": PROBLEM},
    }
    assert not getattr(store.work, change)(held(first), **arguments.get(change, {}))
    assert now(store, job) == before
    assert store.work.succeed(held(second), result_sha256="cd", result_bytes=2)


@pytest.mark.parametrize("change", ["report", "succeed", "fail", "hand_back", "retry_or_fail"])
def test_a_dismissed_job_stays_dismissed(store, change):
    job = asked(store)
    first = claimed(store)
    dismissed = store.of("local").jobs.dismiss(job.id)
    arguments = {
        "report": {"stage": "late", "fraction": 0.9},
        "succeed": {"result_sha256": "ab", "result_bytes": 2},
        "fail": {"problem": PROBLEM},
        "retry_or_fail": {"problem": PROBLEM},
    }
    assert not getattr(store.work, change)(held(first), **arguments.get(change, {}))
    assert now(store, job) == dismissed


def test_a_job_that_took_down_whoever_computed_it_again_and_again_fails(store):
    job = asked(store)
    for attempt in range(1, MOST_ATTEMPTS + 1):
        taken = claimed(store)
        assert taken.attempts == attempt
        store.work.retry_or_fail(held(taken), PROBLEM)
    assert (now(store, job).state, now(store, job).problem) == ("failed", PROBLEM)
    assert claimed(store) is None


def test_handing_a_job_back_does_not_count_as_an_attempt(store):
    job = asked(store)
    for _ in range(2 * MOST_ATTEMPTS):
        store.work.hand_back(held(claimed(store)))
    assert now(store, job).attempts == 0


def test_a_worker_knows_what_it_still_holds(store):
    for number in range(3):
        asked(store, number)
    mine, lost, theirs = claimed(store), claimed(store), claimed(store, OTHER)
    store.of("local").jobs.dismiss(lost.id)
    assert store.work.held(MINE) == {held(mine)}
    assert set(store.work.running_elsewhere(MINE)) == {held(theirs)}


def test_a_job_is_not_buried_where_its_owner_showed_life_meanwhile(store):
    asked(store)
    taken = claimed(store, OTHER)
    ((_, beat),) = store.work.running_elsewhere(MINE).values()
    store.work.beat(OTHER)
    assert not store.work.retry_or_fail(held(taken), PROBLEM, beat=beat)
    assert store.work.retry_or_fail(held(taken), PROBLEM, beat=beat + 1)
