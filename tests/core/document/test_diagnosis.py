"""The document of a real diagnosis: an arm whose torque ripples, from its log to the page."""

import csv
import io
import json
import re

import numpy as np
import pytest
from pydantic import BaseModel

from tests.app.planar_arm import columns, description
from tests.core.report.page.test_page import Page
from veritorque.app.client.result import Result
from veritorque.app.schemas.results import ResultDocument
from veritorque.core.document.model.model_file import read_model
from veritorque.core.document.model.reading import identified_model, identified_robot
from veritorque.core.export.formats import FORMATS
from veritorque.core.log.reader import log_from_arrays
from veritorque.core.report.page.page import compose_page
from veritorque.core.robot.description import robot_from_description
from veritorque.core.study import IdentifyRequest, diagnose

AMPLITUDE, HARMONIC = 0.3, 7.0


@pytest.fixture(scope="module")
def document():
    time, position, torque = columns(seconds=30.0, noise=0.1)
    torque[:, 1] += AMPLITUDE * np.cos(HARMONIC * position[:, 1] + 0.4)
    log = log_from_arrays("rippled", time, np.round(position, 5), torque)  # an encoder has steps
    robot = robot_from_description(description())
    return diagnose(IdentifyRequest(robot, (log,), {"bootstrap": {"draws": 0}}))


def test_the_document_is_json_and_follows_the_contract(document):
    ResultDocument.model_validate_json(json.dumps(document, allow_nan=False))
    assert document["kind"] == "diagnose"


def unnamed(model, place=""):
    """List the fields of an answer that its contract does not name."""
    inside = {name: getattr(model, name) for name in type(model).model_fields}
    found = [f"{place}/{name}" for name in model.model_extra or {}]
    for name, value in inside.items():
        for one in value if isinstance(value, list) else [value]:
            if isinstance(one, BaseModel):
                found += unnamed(one, f"{place}/{name}")
    return found


def test_the_contract_names_every_field_of_a_diagnosis(document):
    diagnosis = ResultDocument.model_validate_json(json.dumps(document)).diagnosis
    assert unnamed(diagnosis) == []
    assert unnamed(
        diagnosis.model_copy(
            update={"gain": [diagnosis.gain[0].model_validate(diagnosis.gain[0].model_dump() | {"extra": 1})]}
        )
    ) == ["/gain/extra"]


def test_the_cause_is_named_with_its_size(document):
    (finding,) = document["diagnosis"]["findings"]
    assert (finding["cause"], finding["joints"]) == ("torque_ripple", [2])
    sizes = {one["name"]: one for one in finding["parameters"]}
    for name, true in (("amplitude", AMPLITUDE), ("harmonic", HARMONIC)):
        # Four deviations: one in ten thousand logs lies further off.
        assert abs(sizes[name]["value"] - true) < 4.0 * sizes[name]["standard_deviation"], sizes[name]


def test_the_gain_is_told_per_joint_on_held_out_data_in_torque_and_in_motion(document):
    diagnosis = document["diagnosis"]
    first, second = diagnosis["gain"]
    assert second["improvement_percent"] > 30.0
    assert second["interval_95"][0] > 0.0
    assert abs(first["improvement_percent"]) < 5.0
    before, after = (diagnosis[side]["validation"][1]["rms_residual"] for side in ("before", "after"))
    # the gain is that of all rows, the errors are those of the moving ones
    assert before == pytest.approx(second["rms_residual_before"], rel=0.05)
    assert after == pytest.approx(second["rms_residual_after"], rel=0.15)
    simulation = diagnosis["simulation"]
    assert simulation["improvement_total_percent"][1] > 0.0
    assert np.shape(simulation["before"]["position_rms"]) == (len(simulation["before"]["horizons_s"]), 2)


def test_the_search_holds_out_what_the_fit_does_where_nothing_happened_there_alone(document):
    assert document["diagnosis"]["held_out"] == document["held_out"] != []


def test_the_extended_model_has_the_old_parameters_and_the_new_ones(document):
    old = [row["name"] for row in document["plain"]["base_parameters"]]
    rows = document["diagnosis"]["after"]["base_parameters"]
    assert [row["name"] for row in rows if not row["new"]] == old
    new = [row for row in rows if row["new"]]
    assert np.hypot(*(row["value"] for row in new)) == pytest.approx(AMPLITUDE, rel=0.1)
    assert all(row["standard_deviation"] > 0.0 for row in new)


def friction_of(text, attribute):
    """Read a drive's number per joint out of an MJCF file."""
    return [float(value) for value in re.findall(rf'<joint [^>]*{attribute}="([^"]+)"', text)]


def test_every_surface_of_a_diagnosis_gives_the_extended_model_with_the_plain_one_beside_it(document):
    written = json.loads(json.dumps(document))
    after = {row["name"]: row["value"] for row in written["diagnosis"]["after"]["base_parameters"]}
    plain = {row["name"]: row["value"] for row in written["plain"]["base_parameters"]}
    base, standard = (
        {row["name"]: row for row in csv.DictReader(io.StringIO(FORMATS[name].write(written).decode()))}
        for name in ("parameters.csv", "standard_parameters.csv")
    )
    assert {name: float(row["value"]) for name, row in base.items()} == after
    assert {name: float(row["value_plain"]) for name, row in base.items() if row["value_plain"]} == plain
    assert abs(after["FC2"] - plain["FC2"]) > 0.001 * plain["FC2"]  # else nothing is shown here
    mjcf, model = (
        FORMATS["robot.xml"].write(written).decode(),
        read_model(FORMATS["model.json"].write(written)),
    )
    client = Result.from_document(written)
    for symbol, attribute in (("FC", "frictionloss"), ("FV", "damping")):
        names = [f"{symbol}{joint}" for joint in (1, 2)]
        told = [after[name] for name in names]
        assert friction_of(mjcf, attribute) == told
        assert [float(standard[name]["value"]) for name in names] == told
        assert [model.values[name] for name in names] == told
        assert [client.base.value[client.base.name.index(name)] for name in names] == told
        own = [client.plain.base.value[client.plain.base.name.index(name)] for name in names]
        assert own == [plain[name] for name in names]
    assert {row["model"] for row in [*base.values(), *standard.values()]} == {client.model} == {"extended"}
    statement = written["model"]["statement"]
    for name in ("robot.urdf", "robot.sdf", "parameters.yaml", "parameters.h", "model.json"):
        assert statement in " ".join(FORMATS[name].write(written).decode().replace("# ", "").split()), name
    assert written["validation"] == written["diagnosis"]["after"]["validation"]
    assert client.plain.model == "plain"


def test_every_finding_has_its_repair_and_a_description_that_is_right_is_not_repaired(document):
    (one,) = document["diagnosis"]["repairs"]
    assert (one["cause"], one["joints"], one["mends"]) == ("torque_ripple", [2], "model")
    assert document["diagnosis"]["repaired_robot"] is None
    assert f"Correction: {one['what']}." in Page(compose_page(json.loads(json.dumps(document)))).text


def test_nothing_is_left_above_the_noise_floor(document):
    left = document["diagnosis"]["unexplained"]
    assert left["joints"] == []
    # The floor counts what Coulomb friction's steps leave in the high band: it may lie above, not below.
    assert (np.divide(left["rms_residual"], left["noise_floor"]) < 1.1).all()


def test_the_atlas_shows_every_joint_over_every_coordinate_that_it_has(document):
    listed = {(one["coordinate"], one["joint"]) for one in document["diagnosis"]["atlas"]}
    assert {(name, joint) for name in ("time", "position", "velocity", "load") for joint in (1, 2)} <= listed


def test_the_page_of_a_real_diagnosis_names_the_cause_in_its_first_sentence(document):
    page = compose_page(json.loads(json.dumps(document)))
    assert "One cause of simulation error found for planar arm: torque ripple (joint 2)." in (page)


def test_the_extended_model_is_in_the_document_with_numbers_that_give_its_base_parameters(document):
    document = json.loads(json.dumps(document))
    found = identified_model(document)
    assert [term.name for term in found.model.terms][-1] == "torque_ripple_2"
    values = found.values
    for row in document["diagnosis"]["after"]["base_parameters"]:
        summed = sum(share * values[name] for name, share in row["relation"].items())
        assert summed == pytest.approx(row["value"], abs=1e-7), row["name"]
    assert read_model(FORMATS["model.json"].write(document)).values == values
    assert "torque_ripple_2" in identified_robot(document).remarks[-1]
