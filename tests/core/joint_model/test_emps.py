"""The model of a measured slide is that of its publication, and its spring is not seen."""

import json

import pyarrow.parquet as pq
import pytest

from tests.tools import shared
from veritorque.core.document.joint_model import joint_document
from veritorque.core.identification.identify import no_progress
from veritorque.core.joint_model.identify import identify_joint
from veritorque.core.joint_model.options import JointOptions
from veritorque.core.joint_model.result import JointModel
from veritorque.core.log.reader import log_from_arrays
from veritorque.core.robot.description import robot_from_description

# Janot, Gautier & Brunot 2019: 95.1 kg, 203.5 N s/m, 20.4 N, -3.16 N by least squares, with positions and
# forces filtered. Estimators by simulation give 95.2 kg, 204 to 211 N s/m, 19.8 to 20.4 N on the same data.
PUBLISHED = {"inertia": (95.1, 1.0), "viscous": (204.0, 10.0), "coulomb": (20.4, 1.0), "offset": (-3.16, 0.3)}
SIMULATED_UM = 1.62
"""Error of the position that a simulation with the published parameters and controller has, um RMS."""


def slide(options: JointOptions, rows: int | None = None) -> JointModel:
    """Identify the slide from the first rows of its log, all by default."""
    folder = shared("data/emps")
    table = pq.read_table(folder / "runs" / "track.parquet").slice(0, rows)
    q, tau, wanted, command = (
        table[f"{name}_1"].to_numpy()[:, None] for name in ("q", "tau", "position_ref", "command")
    )
    time = table["time"].to_numpy()
    log = log_from_arrays("emps", time, q, tau, position_ref=wanted, command=command)
    robot = robot_from_description(json.loads((folder / "robot.json").read_text()))
    return identify_joint(robot, log, options, no_progress)


@pytest.mark.parametrize("estimator", ["srivc", "clsrivc"])
def test_mass_and_friction_are_those_of_the_publication(estimator):
    found = slide(JointOptions(1, "rigid", estimator))
    assert found.rigid.failure is None
    for name, (value, tolerance) in PUBLISHED.items():
        assert found.rigid.parameters.at(name)[0] == pytest.approx(value, abs=tolerance), name
    assert 0.1 < found.rigid.parameters.at("inertia")[1] < 0.6
    assert found.rigid.held_out.torque_percent < 5.0
    if estimator == "clsrivc":
        assert 1e6 * found.rigid.held_out.position_rms == pytest.approx(SIMULATED_UM, abs=0.1)


def test_no_spring_is_seen_in_the_slide():
    found = slide(JointOptions(1), 8000)
    assert found.flexible.failure is not None
    document = joint_document(found, version="0", options={})
    assert document["flexibility"]["seen"] is False
    assert document["models"][1]["parameters"] == []
    units = {row["name"]: row["unit"] for row in document["models"][0]["parameters"]}
    assert units == {"inertia": "kg", "viscous": "N s/m", "coulomb": "N", "offset": "N"}
