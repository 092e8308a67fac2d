"""The demonstration: what it prints from a document, what it says when something fails, the real thing."""

import json
import re
import threading
from http.server import BaseHTTPRequestHandler, HTTPServer
from typing import ClassVar

import pytest
from rich.console import Console

from examples.yumi import demo, diagnosis, service, summary
from tests.core.report.documents import diagnosed, nothing_found
from veritorque.app.client.errors import ServiceError

RESULT = {
    "counts": {"standard": 98, "base": 71, "essential": 57},
    "base_parameters": [
        {
            "name": "ZZR1", "unit": "kg m2", "joint": 1, "value": 0.0665, "value_ols": -0.061,
            "standard_deviation": 0.002, "relative_deviation_percent": 3.01, "essential": True,
            "relation": {"ZZ1": 1.0, "IA1": 1.0, "M2": 0.0009},
            "interval_95": [0.0625, 0.0705], "surprise": [1],
        },
        {"name": "FC1", "unit": "N m", "value": 2.2, "value_ols": 2.2, "standard_deviation": 0.01},
    ],
    "feasibility": {
        "feasible": True, "pseudo_inertia_min_eigenvalue": [0.002, 0.001], "ols_feasible": False,
    },
    "solver": {"status": "optimal", "iterations": 11, "objective": 2.5, "objective_ols": 2.4},
    "fit": [{"joint": 1, "rms_torque": 4.0, "nrmse_of_range_percent": 1.25, "nrmse_of_rms_percent": 3.5}],
    "validation": [],
}  # fmt: skip  # a table
TRUTH = {"ZZ1": 0.03, "IA1": 0.025, "M2": 5.0, "FC1": 2.175}


@pytest.fixture
def page(capsys):
    summary.print_summary(Console(width=100), RESULT, TRUTH)
    return capsys.readouterr().out


def test_a_base_parameter_is_printed_beside_what_its_grouping_makes_of_the_truth(page):
    # 0.03 + 0.025 + 0.0009 * 5 = 0.0595; (0.0665 - 0.0595) / 0.002 = 3.5
    line = next(line for line in page.splitlines() if "ZZR1" in line)
    assert line.split() == ["ZZR1*", "0.0665", "0.004", "3.01", "-0.061", "0.0595", "+3.5", "kg", "m2"]


def test_a_parameter_without_a_grouping_has_no_true_value(page):
    line = next(line for line in page.splitlines() if "FC1" in line)
    assert line.split() == ["FC1", "2.2", "2.2", "N", "m"]


def test_the_page_tells_counts_feasibility_solver_and_truth(page):
    assert "98 standard -> 71 base -> 57 essential" in page
    assert "Least squares: physically inconsistent" in page
    assert "Identified parameters: physically consistent" in page
    assert "optimal, 11 iterations" in page
    assert "0 of 1 base parameters within" in page


def test_without_a_truth_nothing_is_said_about_it(capsys):
    summary.print_summary(Console(width=100), RESULT, None)
    page = capsys.readouterr().out
    assert "Truth" not in page
    assert "true" not in page


def told(capsys, result, hidden=None):
    diagnosis.print_diagnosis(Console(width=200), result, hidden)
    return " ".join(capsys.readouterr().out.split())


def test_a_diagnosis_tells_what_is_wrong_why_and_what_the_correction_gains(capsys):
    page = told(capsys, diagnosed())
    head = (
        "One cause of simulation error found for bench arm: "
        "load-dependent friction, or a similar cause (joint 1)."
    )
    assert f"{head} 1. Load-dependent friction on joint 1:" in page
    assert "Confidence 98 %, p = 1e-09, corrected for all candidates." in page
    gain = "reduces the error on the joint by 33 % (95 %: 20 to 45 %), up to 20 Hz, on held-out data."
    assert gain in page
    assert (
        "Not distinguishable from torque gain on joint 1; separating experiment: run both directions." in page
    )
    assert "Rejected: torque ripple on joint 1: the reason about torque_ripple." in page
    assert "1 0.2 N m 0.1 N m 50.00 40.0 to 60.0 50.00" in page
    assert "torque up to 9.5 Hz; simulated motion over 50, 200 ms" in page
    assert "The remaining residual is not predictable" in page
    assert "hidden" not in page


def test_what_was_hidden_is_set_beside_what_was_found_or_said_to_be_missed(capsys):
    cause, other = "friction_load_dependent", "torque_ripple"
    hidden = [
        {"cause": cause, "joints": [1], "parameters": {"load_coefficient": 0.064}},
        {"cause": other, "joints": [1], "parameters": {"amplitude": 0.12}},
        {"cause": cause, "joints": [2], "parameters": {"load_coefficient": 0.07}},
    ]
    page = told(capsys, diagnosed(), hidden)
    # (0.07 - 0.064) / 0.002 = 3
    assert "friction load dependent on joint 1 load coefficient 0.064 0.07 ± 0.002 +3.0" in page
    assert "torque ripple on joint 1 amplitude 0.12 not found" in page
    assert "friction load dependent on joint 2 load coefficient 0.07 not found" in page


def test_a_diagnosis_that_found_nothing_says_so(capsys):
    assert "No cause of simulation error found for" in told(capsys, nothing_found())


def test_what_stays_predictable_is_told_with_its_joint(capsys):
    left = diagnosed()["diagnosis"]["unexplained"]
    left |= {"joints": [2], "predictable_residual_fraction": [0.0, 0.2]}
    page = told(capsys, diagnosed(verdict="unexplained", unexplained=left))
    assert (
        "Explainable variance of the residual (R2, upper bound), without a known cause: 20 % on joint 2."
        in page
    )


class Answers(BaseHTTPRequestHandler):
    """Answer from a table of (method, path) to (status, document)."""

    table: ClassVar[dict] = {}

    def answer(self):
        self.rfile.read(int(self.headers.get("Content-Length", 0)))
        found = self.table.get((self.command, self.path.partition("?")[0]), (404, {"detail": "nothing here"}))
        status, document = found
        body = json.dumps(document).encode()
        self.send_response(status)
        self.send_header("Content-Type", "application/problem+json" if status >= 400 else "application/json")
        self.send_header("Content-Length", str(len(body)))
        self.end_headers()
        self.wfile.write(body)

    do_GET = do_POST = answer  # noqa: N815  (the server's own names)

    def log_message(self, *_):
        pass


@pytest.fixture
def served():
    server = HTTPServer(("127.0.0.1", 0), Answers)
    thread = threading.Thread(target=server.serve_forever, kwargs={"poll_interval": 0.01})
    thread.start()
    yield f"http://127.0.0.1:{server.server_port}"
    server.shutdown()
    thread.join()
    server.server_close()


def test_the_demonstration_prints_a_problem_documents_remedy_and_fails(served, monkeypatch, capsys):
    problem = {"title": "no", "cause": "two columns [are] missing", "remedy": "name tau_1 and tau_2"}
    monkeypatch.setattr(Answers, "table", {("POST", "/v1/logs"): (422, problem)})
    assert demo.main(["--url", served]) == 1
    page = capsys.readouterr().out
    assert "two columns [are] missing" in page
    assert "name tau_1 and tau_2" in page


@pytest.mark.parametrize("url", ["http://127.0.0.1:9", "nowhere", "file:///etc"])
def test_a_service_that_is_not_there_is_a_problem_with_a_remedy(url, capsys):
    assert demo.main(["--url", url]) == 1
    assert "remedy:" in capsys.readouterr().out


def test_a_log_that_is_not_there_is_named(served, capsys):
    assert demo.main(["--url", served, "--log", "absent.csv"]) == 1
    assert "absent.csv cannot be read" in capsys.readouterr().out


def test_a_service_that_does_not_start_says_its_last_words(tmp_path, monkeypatch):
    monkeypatch.setattr(service, "ROOT", tmp_path)  # where there is no app to start
    monkeypatch.delenv("PYTHONPATH", raising=False)  # nor one to be found elsewhere
    with pytest.raises(ServiceError) as caught, service.running_service(tmp_path / "data"):
        pass
    assert caught.value.cause == "the service did not start"
    assert "veritorque" in caught.value.evidence["last_words"]


NUMBER = r"[+-]?\d+(?:\.\d+)?"


def is_printed(line, words):
    """Tell whether a line stands in a page, its numbers as near as another machine may round them."""
    line = " ".join(line.split())
    numbers = [float(one) for one in re.findall(NUMBER, line)]
    pattern = f"({NUMBER})".join(re.escape(part) for part in re.split(NUMBER, line))
    found = [[float(one) for one in match.groups()] for match in re.finditer(pattern, words)]
    return any(one == pytest.approx(numbers, rel=0.1) for one in found)


def test_a_line_is_printed_where_its_words_and_about_its_numbers_stand():
    page = "Torque ripple on joint 4: amplitude 0.118 ± 0.006 N m, 8.98 ± 0.1 cycles per revolution"
    assert is_printed("Torque ripple on joint 4: amplitude 0.12 ± 0.006 N m,", page)
    assert is_printed("per revolution", page)
    assert not is_printed("Torque ripple on joint 2: amplitude 0.118 ± 0.006 N m,", page)
    assert not is_printed("Torque ripple on joint 4: amplitude 0.18 ± 0.006 N m,", page)
    assert not is_printed("Torque ripple on joint 4: phase", page)


@pytest.mark.slow
def test_the_demonstration_identifies_the_arm_through_the_real_service(tmp_path, capsys):
    saved = tmp_path / "result.json"
    assert demo.main(["--data-dir", str(tmp_path / "data"), "--json", str(saved)]) == 0
    result = json.loads(saved.read_text(encoding="utf-8"))
    assert (result["counts"]["standard"], result["counts"]["base"]) == (98, 71)
    assert result["feasibility"]["ols_feasible"] is False
    assert min(result["feasibility"]["pseudo_inertia_min_eigenvalue"]) > 0.0
    truth = json.loads((demo.HERE / "truth.json").read_text(encoding="utf-8"))["standard_parameters"]
    distances = [abs(summary.deviations(row, truth)) for row in result["base_parameters"]]
    assert sum(distance <= 1.96 for distance in distances) >= 60  # of 71: 95 % expected, correlated
    assert max(distances) < 5.0
    page = capsys.readouterr().out
    assert "Time from upload to result" in page
    words = " ".join(page.split())
    assert (
        words.index("Time from upload to result")
        < words.index("hidden_log.csv")
        < words.index("Hidden effects")
    )
    assert "not found" not in words
    told = re.findall(r"(?m)^ +.*?([+-]\d+\.\d) *$", page[page.index("Hidden effects") :])
    assert len(told) == 4
    assert all(abs(float(z)) < 3.0 for z in told)  # one log in four hundred exceeds 3 per number
    guide = (demo.ROOT / "docs" / "diagnosis.md").read_text(encoding="utf-8")
    shown = re.search(r"```\n(\w+ causes of simulation error.*?)```", guide, re.DOTALL)
    assert all(is_printed(line, words) for line in shown.group(1).splitlines() if line[:1] != " ")
    report = (tmp_path / "data" / "diagnosis.html").read_text(encoding="utf-8")
    assert "Two causes of simulation error found" in report
    assert "torque ripple (joint 4)" in report
    assert "load-dependent friction (joint 2)" in report
