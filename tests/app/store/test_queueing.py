"""Jobs that are asked for together are treated as if they had been asked for one after the other."""

from sqlalchemy import event
from sqlalchemy.exc import DataError, IntegrityError

from tests.app.stubs import add_job
from veritorque.app.store import queueing
from veritorque.app.store.errors import KeyReusedError, OverQuotaError
from veritorque.app.store.queueing import NewJob
from veritorque.app.store.records import JobRequestRecord, Quota
from veritorque.app.store.store import Store


def asked(number=0, key=None):
    return NewJob(JobRequestRecord("identify", "arm", ("log-1",), {"number": number}), key)


def names(outcomes):
    """Write each outcome as the place of the first that is the same, or as the name of the error."""
    ids = [type(one).__name__ if isinstance(one, Exception) else one.id for one in outcomes]
    return [one if one.endswith("Error") else ids.index(one) for one in ids]


TOGETHER = [
    *(asked(1), asked(2), asked(1), asked(3, "k"), asked(3, "k")),
    *(asked(4, "k"), asked(1, "l"), asked(5, "l")),
]


def test_together_gives_what_one_after_the_other_gives(store):
    one_by_one = [store.of("one").jobs.begin_to_add([one])()[0] for one in TOGETHER]
    together = store.of("two").jobs.begin_to_add(TOGETHER)()
    assert names(together) == names(one_by_one) == [0, 1, 0, 3, 3, "KeyReusedError", 0, "KeyReusedError"]
    assert len(store.of("two").jobs.page(limit=9)) == 3


def test_what_was_asked_for_earlier_answers_those_who_come_together(store):
    jobs = store.of("local").jobs
    first, keyed = add_job(jobs, asked(1).request), add_job(jobs, asked(2).request, key="k")
    jobs.dismiss(keyed.id)
    found = jobs.begin_to_add([asked(1), asked(2, "k"), asked(2), asked(1, "k")])()
    assert [found[0].id, found[1].id] == [first.id, keyed.id]
    assert found[2].id not in (first.id, keyed.id)
    assert isinstance(found[3], KeyReusedError)


def test_a_full_queue_takes_the_first_and_refuses_the_rest(tmp_path, database_url):
    store = Store(tmp_path, database_url, quota=Quota(queued=2))
    outcomes = store.of("local").jobs.begin_to_add([asked(1), asked(2), asked(3), asked(1), asked(4)])()
    assert names(outcomes) == [0, 1, "OverQuotaError", 0, "OverQuotaError"]
    assert isinstance(store.of("local").jobs.begin_to_add([asked(5)])()[0], OverQuotaError)
    store.close()


def test_what_is_asked_of_the_database_does_not_grow_with_the_number_of_requests(store):
    statements = []
    event.listen(
        store.database._engine, "before_cursor_execute", lambda _c, _k, text, *_: statements.append(text)
    )

    def count(requests):
        statements.clear()
        store.of("local").jobs.begin_to_add(requests)()
        return len([one for one in statements if "advisory" not in one])

    assert count([asked(n) for n in range(100)]) == count([asked(1000)])


def test_a_request_that_the_database_refuses_takes_none_of_the_others_with_it(store, monkeypatch):
    row = queueing._row
    spoilt = {"trace": "\0", "id": None}  # PostgreSQL takes no NUL, SQLite no absent id
    monkeypatch.setattr(
        queueing, "_row", lambda tenant, one: row(tenant, one) | (spoilt if one.trace == "bad" else {})
    )
    bad = NewJob(JobRequestRecord("identify", "arm", (), {}), None, "bad")
    outcomes = store.of("local").jobs.begin_to_add([asked(1), bad, asked(2)])()
    assert isinstance(outcomes[1], IntegrityError | DataError)
    assert {job.request.options["number"] for job in store.of("local").jobs.page(limit=9)} == {1, 2}
    assert [outcomes[0].state, outcomes[2].state] == ["accepted", "accepted"]


def test_jobs_alike_are_found_by_their_fingerprints_however_many_are_asked_for(tmp_path):
    store, plans = Store(tmp_path), []

    def explain(connection, cursor, text, given, *_):
        if "fingerprint IN" in text:
            plans.extend(cursor.execute("EXPLAIN QUERY PLAN " + text, given).fetchall())

    event.listen(store.database._engine, "before_cursor_execute", explain)
    store.of("local").jobs.begin_to_add([asked(n) for n in range(50)])()
    store.close()
    assert "ix_jobs_tenant_fingerprint" in str(plans)
