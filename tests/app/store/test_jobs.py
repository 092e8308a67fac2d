"""The same request is the same job; another tenant's is not."""

import pytest

from tests.app.stubs import add_job
from veritorque.app.store.errors import KeyReusedError
from veritorque.app.store.records import JobRequestRecord


def request(number=0):
    return JobRequestRecord("identify", "arm", ("log-1",), {"number": number})


def test_the_same_request_finds_the_job_that_answers_it(store):
    jobs = store.of("local").jobs
    first = add_job(jobs, request())
    assert add_job(jobs, request()).id == first.id
    assert add_job(jobs, request(1)).id != first.id


@pytest.mark.parametrize("end", ["dismissed", "failed"])
def test_a_job_without_an_answer_does_not_stand_for_a_later_request(store, end):
    jobs = store.of("local").jobs
    first = add_job(jobs, request())
    taken = store.work.claim("worker", most_per_tenant=9)
    if end == "failed":
        store.work.fail((taken.id, taken.token), {"cause": "slow"})
    else:
        jobs.dismiss(first.id)
    assert add_job(jobs, request()).id != first.id


def test_a_key_stands_for_one_request_even_when_its_job_failed(store):
    jobs = store.of("local").jobs
    first = add_job(jobs, request(), key="k")
    jobs.dismiss(first.id)
    assert add_job(jobs, request(), key="k").id == first.id
    with pytest.raises(KeyReusedError):
        add_job(jobs, request(1), key="k")
    jobs.remove(first.id)
    assert add_job(jobs, request(), key="k").id != first.id


def test_tenants_do_not_see_each_other(store):
    one, two = store.of("one").jobs, store.of("two").jobs
    job = add_job(one, request(), key="k")
    assert add_job(two, request(), key="k").id != job.id
    assert two.get(job.id) is None
    assert two.dismiss(job.id) is None
    assert not two.remove(job.id)
    assert [listed.tenant for listed in two.page(limit=9)] == ["two"]
    assert one.get(job.id).state == "accepted"


def test_pages_follow_each_other_whatever_comes_meanwhile(store):
    jobs = store.of("local").jobs
    ids = [add_job(jobs, request(number)).id for number in range(5)]
    first = jobs.page(limit=2)
    add_job(jobs, request(9))
    second = jobs.page(limit=2, before=first[-1].sequence)
    assert [job.id for job in (*first, *second)] == ids[:0:-1]
