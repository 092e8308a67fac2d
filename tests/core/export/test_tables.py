"""The table formats are read back by the parsers that users have, number for number."""

import csv
import io
import json
import shutil
import subprocess
from dataclasses import replace

import numpy as np
import pytest
from ruamel.yaml import YAML
from scipy.io import loadmat

from tests.core.export.robots import ROBOTS, brisk, identified
from tests.core.report.documents import identified as result
from veritorque.core.document.model.identified import IdentifiedRobot
from veritorque.core.dynamics.terms.coulomb import Coulomb
from veritorque.core.dynamics.terms.coupling import GearCoupling
from veritorque.core.export.c_header import c_name, write_c_header
from veritorque.core.export.content import content
from veritorque.core.export.formats import FORMATS
from veritorque.core.export.matlab import write_matlab
from veritorque.core.export.yaml import write_yaml
from veritorque.core.robot.model import INERTIAL_SYMBOLS


@pytest.fixture(params=ROBOTS, scope="module")
def found(request):
    return identified(ROBOTS[request.param])


def smoothed(found):
    """Give the same robot with the sign of its friction smoothed, every joint over another width."""
    robot = found.robot
    widths = tuple(0.1 * (1 + joint) for joint in range(len(robot.joints)))
    model = found.model.with_term(Coulomb(widths))
    if robot.couplings:
        model = model.with_term(GearCoupling(tuple(0.05 for _ in robot.couplings)))
    values = np.array([found.values[one.name] for one in model.parameters])
    return IdentifiedRobot(model, values, ("in_combination",) * len(values))


@pytest.mark.parametrize("version", [(1, 1), (1, 2)], ids=["YAML 1.1", "YAML 1.2"])
def test_yaml_is_read_back_number_for_number_by_either_version_of_the_language(found, version):
    parser = YAML(typ="safe", pure=True)
    parser.version = version
    assert parser.load(write_yaml(found)) == json.loads(json.dumps(content(found)))


def test_numbers_that_are_tiny_huge_or_whole_are_numbers_in_yaml(found):
    odd = found.standard.copy()
    odd[:5] = [1e-5, -2.5e-300, 1e22, 3.0, 0.0]
    text = write_yaml(IdentifiedRobot(found.model, odd, found.identifiable))
    parser = YAML(typ="safe", pure=True)
    parser.version = (1, 1)
    assert [row["value"] for row in parser.load(text)["standard_parameters"]] == odd.tolist()


def test_a_matlab_file_is_read_back_number_for_number(found):
    struct = loadmat(io.BytesIO(write_matlab(found)), simplify_cells=True)["identified"]
    assert struct["robot"] == found.robot.name
    for rows, known in (("standard_parameters", found.standard), ("base_parameters", [0.25, -1e-05])):
        np.testing.assert_array_equal([row["value"] for row in struct[rows]], known)
    bodies = [[link[symbol] for symbol in INERTIAL_SYMBOLS] for link in struct["links"]]
    np.testing.assert_array_equal(bodies, found.links)
    for link, own in zip(struct["links"], found.robot.links, strict=True):
        np.testing.assert_array_equal(link["rotation"], own.rotation)
        assert (link["name"], link["kind"], link["antecedent"]) == (own.name, own.kind, own.antecedent)
    np.testing.assert_array_equal([joint["FC"] for joint in struct["joints"]], found.of_joints("FC"))
    motors = np.atleast_1d(struct["coupled_motors"])
    assert [motor["name"] for motor in motors] == [one.coupling.name for one in found.motors]


def test_equal_results_are_equal_matlab_files_whenever_they_are_written(found):
    assert write_matlab(found) == write_matlab(found)
    assert b"Created" not in write_matlab(found)


def test_csv_is_read_back_row_by_row():
    document = result()
    for name, rows in (
        ("parameters.csv", "base_parameters"),
        ("standard_parameters.csv", "standard_parameters"),
    ):
        read = list(csv.DictReader(io.StringIO(FORMATS[name].write(document).decode())))
        assert [float(row["value"]) for row in read] == [row["value"] for row in document[rows]]
        assert [row["name"] for row in read] == [row["name"] for row in document[rows]]


PROGRAMME = """#include <stdio.h>
#include "robot.h"
#include "robot.h"

int main(void)
{
    double q[64], dq[64], ddq[64], tau[64], M[64 * 64];
    int j;
    while (1) {
        for (j = 0; j < ROBOT.joints; ++j)
            if (scanf("%lf %lf %lf", &q[j], &dq[j], &ddq[j]) != 3) return 0;
        veritorque_inverse_dynamics(&ROBOT, q, dq, ddq, tau);
        for (j = 0; j < ROBOT.joints; ++j) printf("%.17g ", tau[j]);
        veritorque_gravity(&ROBOT, q, tau);
        for (j = 0; j < ROBOT.joints; ++j) printf("%.17g ", tau[j]);
        veritorque_inertia_matrix(&ROBOT, q, M);
        for (j = 0; j < ROBOT.joints * ROBOT.joints; ++j) printf("%.17g ", M[j]);
        printf("\\n");
    }
}
"""


@pytest.fixture(scope="session")
def compiler():
    found = shutil.which("cc")
    if found is None:
        pytest.skip("SKIPPED FOR WANT OF A C COMPILER: no cc on the path, the C header is not compiled")
    return found


def computed_in_c(compiler, folder, found, state):
    """Compile the header into a programme; give torque, gravity and inertia matrix at every instant."""
    (folder / "robot.h").write_text(write_c_header(found), encoding="utf-8")
    name = c_name(found.robot.name)
    (folder / "main.c").write_text(PROGRAMME.replace("ROBOT", name), encoding="utf-8")
    strict = ["-std=c99", "-pedantic", "-Wall", "-Wextra", "-Werror", "-O1"]
    subprocess.run([compiler, *strict, "-o", "main", "main.c", "-lm"], cwd=folder, check=True)
    motion = np.stack([state.position, state.velocity, state.acceleration], axis=-1)
    text = "\n".join(" ".join(repr(float(one)) for one in row.ravel()) for row in motion)
    answer = subprocess.run(
        [folder / "main"], input=text, capture_output=True, text=True, check=True, cwd=folder
    )
    rows = np.array([[float(one) for one in line.split()] for line in answer.stdout.splitlines()])
    joints = state.position.shape[1]
    return rows[:, :joints], rows[:, joints : 2 * joints], rows[:, 2 * joints :].reshape(-1, joints, joints)


def test_the_c_header_computes_the_whole_torque_of_the_model(compiler, found, tmp_path):
    state = brisk(found.robot)
    theirs, _, _ = computed_in_c(compiler, tmp_path, found, state)
    np.testing.assert_allclose(theirs, found.model.torque(found.standard, state), rtol=0, atol=1e-9)


def test_the_c_header_computes_gravity_and_the_inertia_matrix_of_the_model(compiler, found, tmp_path):
    state, model = brisk(found.robot), found.model
    _, gravity, inertia = computed_in_c(compiler, tmp_path, found, state)
    still = replace(state, velocity=np.zeros_like(state.velocity), acceleration=np.zeros_like(state.velocity))
    at_rest = model.torque(found.standard, still)
    np.testing.assert_allclose(gravity, at_rest - found.of_joints("OFF"), rtol=0, atol=1e-9)
    for joint in range(state.position.shape[1]):
        pushed = still.acceleration.copy()
        pushed[:, joint] = 1.0
        column = model.torque(found.standard, replace(still, acceleration=pushed)) - at_rest
        np.testing.assert_allclose(inertia[:, :, joint], column, rtol=0, atol=1e-9)


@pytest.mark.parametrize("name", ["yumi-left", "two coupled motors"])
def test_the_c_header_smooths_the_sign_of_friction_as_the_model_does(compiler, name, tmp_path):
    found = smoothed(identified(ROBOTS[name]))
    state = brisk(found.robot)
    theirs, _, _ = computed_in_c(compiler, tmp_path, found, state)
    np.testing.assert_allclose(theirs, found.model.torque(found.standard, state), rtol=0, atol=1e-9)
