"""What a diagnosis found stands, even where the programme of the cured model cannot be solved."""

from tests.plant.cache import kept
from tests.plant.cases import draw
from veritorque.core import study
from veritorque.core.errors import SolverError
from veritorque.core.identification import identify as fitting
from veritorque.core.study import IdentifyRequest


def test_findings_stand_where_the_extended_model_cannot_be_identified(monkeypatch):
    case = kept(draw, 912, "torque_ripple", 3.0, robot="planar-2", noise="white")
    solved = []

    def once(*arguments):
        if solved:
            raise SolverError("the solver stopped: AlmostSolved", evidence={}, remedy="move more")
        solved.append(estimate(*arguments))
        return solved[0]

    estimate = fitting.estimate
    monkeypatch.setattr(fitting, "estimate", once)
    document = study.diagnose(IdentifyRequest(case.believed, (case.log,), {"bootstrap": {"draws": 0}}))
    diagnosis = document["diagnosis"]
    assert [one["cause"] for one in diagnosis["findings"]] == ["torque_ripple"]
    assert diagnosis["after"] == {"validation": [], "base_parameters": []}
    assert "AlmostSolved" in diagnosis["simulation"]["note"]
