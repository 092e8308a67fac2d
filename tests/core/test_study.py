"""Test the whole computation: one request, one document, every failure said by name."""

import json
from collections.abc import Callable, Iterator
from dataclasses import replace

import numpy as np
import pytest

from tests.core.estimate.worlds import log_of, planar_robot, swing, true_parameters, wrist_robot
from veritorque.core.document.base_parameters import base_parameters
from veritorque.core.document.version import product_version
from veritorque.core.dynamics.model import standard_model
from veritorque.core.errors import LogError, OptionError, VeritorqueError
from veritorque.core.log.model import ArraySource, JointLog, LogRows, whole_rows
from veritorque.core.log.reader import log_from_arrays, read_log
from veritorque.core.robot.builtin import builtin_robot
from veritorque.core.robot.model import RobotModel
from veritorque.core.signals import condition as conditioning
from veritorque.core.signals import segment
from veritorque.core.signals.parallel import Tile
from veritorque.core.study import IdentifyRequest, identify, identify_in_full

MODEL = standard_model(planar_robot())
NOISE = 0.02
FEW = {"bootstrap": {"draws": 5}}


def _log(robot: RobotModel = MODEL.robot, seed: int = 1, noise: float = NOISE) -> JointLog:
    model = standard_model(robot)
    state = swing(len(robot.joints), seed=seed)
    rough = noise * np.random.default_rng(seed).normal(size=state.position.shape)
    return log_of(model, true_parameters(model), state, rough)


def _request(*logs: JointLog, robot: RobotModel = MODEL.robot, **options: object) -> IdentifyRequest:
    return IdentifyRequest(robot, logs or (_log(robot),), FEW | options)


@pytest.fixture(scope="module")
def document() -> dict[str, object]:
    return identify(_request())


def test_the_same_request_gives_the_same_document_byte_for_byte(document):
    assert json.dumps(identify(_request())) == json.dumps(document)


def test_the_document_is_json_without_nan_or_infinity_and_comes_back_whole(document):
    assert json.loads(json.dumps(document, allow_nan=False)) == document


CONTRACT = {
    "": "schema_version kind robot logs provenance counts base_parameters terms"
    " standard_parameters feasibility solver fit validation condition_number defects diagnosis",
    "provenance": "version log_sha256 options",
    "counts": "standard base essential",
    "base_parameters": "name unit joint value value_ols standard_deviation relative_deviation_percent"
    " essential grouping",
    "standard_parameters": "name joint unit value identifiable",
    "feasibility": "pseudo_inertia_min_eigenvalue active_constraints mass_matrix_min_eigenvalue",
    "solver": "status iterations objective objective_ols",
    "fit": "joint rms_torque rms_residual nrmse_of_range_percent nrmse_of_rms_percent",
    "validation": "joint rms_torque rms_residual nrmse_of_range_percent nrmse_of_rms_percent",
}


@pytest.mark.parametrize(("part", "names"), CONTRACT.items())
def test_every_field_of_the_contract_is_there_under_its_name(document, part, names):
    found = document[part] if part else document
    for row in found if isinstance(found, list) else [found]:
        assert set(names.split()) <= set(row)


def test_the_document_says_what_the_contract_says_it_means(document):
    assert (document["schema_version"], document["kind"], document["diagnosis"]) == ("1.0", "identify", None)
    assert document["counts"]["base"] == len(document["base_parameters"]) == 13
    assert document["counts"]["essential"] == sum(row["essential"] for row in document["base_parameters"])
    assert [row["joint"] for row in document["fit"]] == [1, 2]
    assert document["feasibility"]["mass_matrix_min_eigenvalue"]["configurations"] == 10_000
    assert document["feasibility"]["feasible"] is True
    assert document["solver"]["objective"] >= document["solver"]["objective_ols"]
    kinds = {row["identifiable"] for row in document["standard_parameters"]}
    assert kinds == {"individually", "in_combination", "no"}
    assert document["provenance"]["options"] == FEW


def test_progress_only_ever_grows_and_stays_within_the_whole():
    seen: list[tuple[str, float]] = []
    identify(_request(smooth_coulomb=True, robust=True), lambda stage, done: seen.append((stage, done)))
    fractions = [done for _, done in seen]
    assert fractions == sorted(fractions)
    assert 0.0 <= fractions[0] <= fractions[-1] <= 1.0
    stages = list(dict.fromkeys(stage for stage, _ in seen))
    assert stages == ["condition", "smooth", "observe", "estimate", "check", "assess", "validate"]


@pytest.mark.parametrize("estimator", ["sdp", "ols", "wls", "irls"])
def test_every_estimator_finds_the_robot_that_made_the_log(estimator):
    found = identify_in_full(_request(estimator=estimator))
    truth = found.base.base_of(true_parameters(MODEL))
    # The plain sign of a filtered velocity changes a sample early or late; 2 % of the largest covers it.
    np.testing.assert_allclose(found.estimate.base, truth, atol=0.02 * np.abs(truth).max())
    assert found.fit_total_percent < 2.0


def test_only_essential_parameters_explain_torque_where_that_is_asked_for():
    found = identify_in_full(_request(_log(noise=1.0), essential=True))
    out = [row for row in range(13) if row not in found.essential.kept]
    assert out
    assert np.all(found.estimate.base[out] == 0.0)


def test_a_coupled_wrist_is_identified_with_its_motor():
    robot = wrist_robot()
    rows = {row["name"]: row for row in identify(_request(robot=robot))["base_parameters"]}
    model = standard_model(robot)
    truth = dict(zip((one.name for one in model.parameters), true_parameters(model), strict=True))
    for name in ("IAM3", "FVM3", "FCM3"):
        assert rows[name]["value"] == pytest.approx(truth[name], abs=0.1)
        assert rows[name]["grouping"] == name


def test_currents_become_torques_by_the_declared_constants():
    rows = whole_rows(_log())
    joints = tuple(replace(one, torque_constant=0.1, gear_ratio=50.0) for one in MODEL.robot.joints)
    robot = replace(MODEL.robot, joints=joints)
    log = log_from_arrays("currents", rows.time, rows.position, None, current=rows.torque / 5.0)
    by_current = identify_in_full(_request(log, robot=robot)).estimate.base
    np.testing.assert_allclose(by_current, identify_in_full(_request()).estimate.base, rtol=1e-6, atol=1e-6)


def _currents() -> JointLog:
    rows = whole_rows(_log())
    return log_from_arrays("currents", rows.time, rows.position, None, current=rows.torque)


def _short() -> JointLog:
    rows = whole_rows(_log())
    return log_from_arrays("short", rows.time[:130], rows.position[:130], rows.torque[:130])


def _interrupted(*gaps: int) -> JointLog:
    """Leave five seconds out before each of these rows."""
    rows = whole_rows(_log())
    time = rows.time + 5.0 * np.searchsorted(gaps, np.arange(len(rows.time)), side="right")
    return log_from_arrays("interrupted", time, rows.position, rows.torque)


REFUSED: dict[str, tuple[Callable[[], IdentifyRequest], type[VeritorqueError], str]] = {
    "three joints for seven": (
        lambda: _request(_log(wrist_robot()), robot=builtin_robot("yumi-left")),
        LogError,
        "numbers of joints",
    ),
    "currents without constants": (lambda: _request(_currents()), LogError, "currents"),
    "no log": (lambda: IdentifyRequest(MODEL.robot, ()), LogError, "no log"),
    "an unknown option": (lambda: _request(colour="red"), OptionError, "does not exist"),
    "an unknown estimator": (lambda: _request(estimator="magic"), OptionError, "not known"),
    "a hold-out of all logs": (
        lambda: _request(validation={"logs": [1]}),
        OptionError,
        "nothing would be left",
    ),
    "a hold-out of a log that is not there": (
        lambda: _request(validation={"logs": [4]}),
        OptionError,
        "nothing would be left",
    ),
    "a hold-out in a stretch that is too short": (
        lambda: _request(_interrupted(990, 1020), validation={"blocks": 200, "fraction": 0.005}),
        OptionError,
        "no sample used lies in the held-out blocks",
    ),
    "a decimation that leaves blocks without instants": (
        lambda: _request(filter={"decimation": 20}, validation={"blocks": 200}),
        OptionError,
        "fewer instants of the log than there are blocks",
    ),
    "a cut-off above the log's rate": (
        lambda: _request(filter={"cutoff_hz": 80}),
        OptionError,
        "does not fit the log's rate",
    ),
    "a bound on a link that is not there": (
        lambda: _request(bounds={"mass": [[9, 1, 2]]}),
        OptionError,
        "link",
    ),
    "terms that this robot does not have": (
        lambda: _request(terms=["coupling"]),
        OptionError,
        "no parameter on this robot",
    ),
    "too short a log": (
        lambda: _request(_short(), filter={"cutoff_hz": 5}),
        VeritorqueError,
        "fewer usable equations",
    ),
}


@pytest.mark.parametrize(("request_of", "kind", "words"), REFUSED.values(), ids=REFUSED.keys())
def test_what_stands_in_the_way_is_said_with_cause_evidence_and_remedy(request_of, kind, words):
    with pytest.raises(kind, match=words) as refusal:
        identify(request_of())
    assert refusal.value.evidence
    assert refusal.value.remedy
    json.dumps(refusal.value.evidence)


def test_the_base_parameters_of_a_structure_are_given_without_a_log():
    found = base_parameters(builtin_robot("yumi-left"))
    assert found["counts"] == {"standard": 98, "base": 71}
    assert {"name", "unit", "joint", "grouping"} <= set(found["base_parameters"][0])


# ------------------------------------------------------------------------------------------------- sabotage


SMOOTH = planar_robot(
    joints=[
        {
            "type": "revolute",
            "alpha": 0.0,
            "d": distance,
            "r": 0.0,
            "theta_offset": 0.0,
            "friction": ["viscous"],
        }
        for distance in (0.0, 0.4)
    ]
)
"""Without the sign of a velocity in it, every column is as smooth as the motion."""


def _error(log: JointLog | None = None, **options: object) -> float:
    """Give the relative error of the strongest law there is: a clean log gives its robot back."""
    found = identify_in_full(_request(log or _log(SMOOTH, noise=0.0), robot=SMOOTH, **options))
    truth = found.base.base_of(true_parameters(found.base.model))
    return float(np.linalg.norm(found.estimate.base - truth) / np.linalg.norm(truth))


LAW = 1e-6
"""Two flat differences at 100 Hz shrink an acceleration of 1.3 Hz by (2 pi 1.3 / 100)^6 / 70 = 4.2e-9, and
the filters of positions bend it by less than a millionth."""


def test_a_clean_log_gives_its_robot_back():
    assert _error() < LAW


def _tiles_with(change: Callable[[object], object]) -> Callable[[object], Iterator[object]]:
    tiles = conditioning.Motion.tiles

    def changed(self: conditioning.Motion, *blocks: object) -> Iterator[object]:
        for tile in tiles(self, *blocks):
            yield change(tile)

    return changed


def test_sabotage_torque_late_by_one_sample_breaks_the_law():
    log = _log(SMOOTH, noise=0.0)
    rows = whole_rows(log)
    late = LogRows(rows.time, rows.position, np.roll(rows.torque, 1, axis=0))
    assert _error(replace(log, source=ArraySource(late))) > 2.0 * LAW


def test_sabotage_filters_cut_off_four_times_too_low_break_the_law(monkeypatch):
    narrow = {"cutoff_hz": 6.0, "position_cutoff_hz": 6.0}
    assert _error(filter=narrow) < LAW
    kernel = segment.kernel
    monkeypatch.setattr(segment, "kernel", lambda cutoff, rate, order: kernel(cutoff / 4.0, rate, order))
    assert _error(filter=narrow) > 2.0 * LAW


def test_sabotage_a_joint_without_acceleration_breaks_the_law(monkeypatch):
    def still(tile: Tile) -> Tile:
        acceleration = tile.state.acceleration.copy()
        acceleration[:, 1] = 0.0
        return replace(tile, state=replace(tile.state, acceleration=acceleration))

    monkeypatch.setattr(conditioning.Motion, "tiles", _tiles_with(still))
    assert _error() > 2.0 * LAW


def test_sabotage_a_solver_that_ignores_the_links_breaks_feasibility(monkeypatch):
    from veritorque.core.estimate import cones, with_clarabel

    monkeypatch.setattr(with_clarabel, "constraint_rows", cones.constraint_rows.__wrapped__)
    monkeypatch.setattr(cones, "add_links", lambda *_: None)
    monkeypatch.setattr(cones, "_add_signs", lambda *_: None)
    found = identify(_request(_log(noise=3.0, seed=3), estimator="sdp"))
    healthy = found["feasibility"]
    assert not healthy["feasible"] or min(healthy["pseudo_inertia_min_eigenvalue"]) < 0.0


def test_the_version_in_the_document_is_that_of_the_package():
    assert identify(_request())["provenance"]["version"] == product_version()


def test_a_log_given_twice_is_refused_because_it_is_no_more_data(tmp_path):
    rows = whole_rows(_log())
    columns = {"time": rows.time}
    for joint in range(rows.position.shape[1]):
        columns |= {f"q_{joint + 1}": rows.position[:, joint], f"tau_{joint + 1}": rows.torque[:, joint]}
    np.savez(tmp_path / "log.npz", **columns)
    log = read_log(tmp_path / "log.npz")
    with pytest.raises(LogError, match="more than once"):
        identify(_request(log, log))


def test_a_reduced_model_is_still_physically_consistent():
    document = identify(_request(_log(noise=2.0), essential=True))
    assert document["counts"]["essential"] < document["counts"]["base"]
    assert document["feasibility"]["feasible"]
