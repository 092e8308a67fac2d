"""A job is followed through streams that break, streams that never come, and services that are away."""

import pytest

from veritorque.app.client import follow
from veritorque.app.client.errors import NoAnswerError, RefusedError
from veritorque.app.client.follow import Follower


def job(fraction, state="running"):
    progress = {"stage": "estimate", "fraction": fraction}
    named = {"id": "7", "kind": "identify", "robot": "r", "logs": [], "options": {}, "problem": None}
    return named | {"state": state, "progress": progress}


DONE = job(1.0, "successful")


class Script:
    """Play a service: a list of what each stream holds, and of what each question is answered."""

    def __init__(self, *, streams=(), answers=()):
        self.streams, self.answers, self.resumed = list(streams), list(answers), []

    def events(self, _path, last):
        self.resumed.append(last)
        for piece in self.streams.pop(0) if self.streams else [NoAnswerError("no stream")]:
            if isinstance(piece, Exception):
                raise piece
            yield piece

    def document(self, _method, _path):
        answer = self.answers.pop(0) if len(self.answers) > 1 else self.answers[0]
        if isinstance(answer, Exception):
            raise answer
        return answer


def fractions(script):
    return [one.fraction for one in Follower(script, "7", pause_s=0.0).changes()]


def test_a_stream_that_breaks_is_taken_up_after_the_last_event_that_was_heard():
    script = Script(
        streams=[[("4", job(0.2)), NoAnswerError("broken")], [("6", job(0.6)), ("7", DONE)]],
        answers=[job(0.2)],
    )
    assert fractions(script) == [0.2, 0.6, 1.0]
    assert script.resumed == ["", "4"]


def test_without_streams_the_service_is_asked_and_streams_are_given_up():
    script = Script(answers=[job(0.1), job(0.1), job(0.3), job(0.3), job(0.9), DONE])
    assert fractions(script) == [0.1, 0.3, 0.9, 1.0]
    assert len(script.resumed) == follow.BARREN


def test_a_service_that_is_away_for_a_while_is_waited_for():
    unavailable = RefusedError("the database does not answer")
    unavailable.kind = "unavailable"
    script = Script(answers=[NoAnswerError("restarting"), unavailable, job(0.5), DONE])
    assert fractions(script) == [0.5, 1.0]


def test_a_service_that_stays_away_is_given_up(monkeypatch):
    monkeypatch.setattr(follow, "PATIENCE_S", 0.05)
    with pytest.raises(NoAnswerError, match="gone"):
        fractions(Script(answers=[NoAnswerError("gone")]))


def test_a_job_that_is_not_there_is_not_waited_for():
    missing = RefusedError("there is no job 7")
    missing.kind = "not-found"
    with pytest.raises(RefusedError, match="no job"):
        fractions(Script(answers=[missing]))
