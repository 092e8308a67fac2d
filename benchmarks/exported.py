"""The exported C header: what one call costs, beside pinocchio's C++ built with the same compiler.

Both programmes go through the same random states, so that no call can be taken out of the loop. pinocchio is
compiled from the headers of its Python package, which need Eigen's; where these or a compiler are not
installed, that is said in the peer's place.
"""

import shutil
import subprocess
import tempfile
from pathlib import Path

import numpy as np
import pinocchio

from benchmarks.figures import Figure
from benchmarks.scene import Scene, yumi_arm
from veritorque.core.document.model.identified import IdentifiedRobot
from veritorque.core.export.c_header import c_name, write_c_header

CALLS = 2_000_000
STATES = 1_024
TARGETS = {"inverse dynamics": "<= 0.5", "gravity": "", "inertia matrix": ""}
EIGEN = Path("/usr/include/eigen3")
DEFINED = (
    "-DBOOST_MPL_LIMIT_LIST_SIZE=30",
    "-DBOOST_MPL_LIMIT_VECTOR_SIZE=30",
    "-DBOOST_MPL_CFG_NO_PREPROCESSED_HEADERS",
    "-DBOOST_FUSION_INVOKE_MAX_ARITY=12",
)
"""What pinocchio's own build file asks its users to define."""

_LOOP = """
enum { JOINTS = @JOINTS, STATES = @STATES, CALLS = @CALLS };
static double state[3][STATES * JOINTS], sum = 0.0;

#define TIMED(name, call, first)                                                 \\
    do {                                                                         \\
        const clock_t begin = clock();                                           \\
        for (int k = 0; k < CALLS; ++k) {                                        \\
            const double *q = state[0] + JOINTS * (k % STATES);                       \\
            const double *dq = state[1] + JOINTS * (k % STATES);                      \\
            const double *ddq = state[2] + JOINTS * (k % STATES);                     \\
            (void)dq; (void)ddq;                                                 \\
            call;                                                                \\
            sum += first;                                                        \\
        }                                                                        \\
        printf("%s: %.6f %.17g\\n", name, 1e6 * (double)(clock() - begin) / CLOCKS_PER_SEC / CALLS, first); \\
    } while (0)

static void fill(void)
{
    srand(1);
    for (int kind = 0; kind < 3; ++kind)
        for (int k = 0; k < STATES * JOINTS; ++k)
            state[kind][k] = 2.0 * rand() / RAND_MAX - 1.0;
}
"""
_OURS = (
    '#include <stdio.h>\n#include <stdlib.h>\n#include <time.h>\n#include "robot.h"\n'
    + _LOOP
    + """
int main(void)
{
    static double tau[JOINTS], M[JOINTS * JOINTS];
    fill();
    TIMED("inverse dynamics", veritorque_inverse_dynamics(&ROBOT, q, dq, ddq, tau), tau[0]);
    TIMED("gravity", veritorque_gravity(&ROBOT, q, tau), tau[1]);
    TIMED("inertia matrix", veritorque_inertia_matrix(&ROBOT, q, M), M[1]);
    return sum == 0.0;
}
"""
)
_THEIRS = (
    "#include <cstdio>\n#include <cstdlib>\n#include <ctime>\n#include <pinocchio/multibody.hpp>\n"
    "#include <pinocchio/algorithm/rnea.hpp>\n#include <pinocchio/algorithm/crba.hpp>\n"
    + _LOOP
    + """
int main()
{
    pinocchio::Model model;
    model.gravity.linear() << GRAVITY;
    Eigen::Matrix3d turn, inertia;
BUILD
    pinocchio::Data data(model);
    fill();
    typedef Eigen::Map<const Eigen::Matrix<double, JOINTS, 1>> Joints;
    TIMED("inverse dynamics", pinocchio::rnea(model, data, Joints(q), Joints(dq), Joints(ddq)), data.tau[0]);
    TIMED("gravity", pinocchio::computeGeneralizedGravity(model, data, Joints(q)), data.g[1]);
    TIMED("inertia matrix", pinocchio::crba(model, data, Joints(q)), data.M(0, 1));
    return sum == 0.0;
}
"""
)


def run(*, quick: bool) -> list[Figure]:
    """Compile both, time them, and compare what they compute."""
    compiler = shutil.which("cc")
    if compiler is None:
        return [Figure("exported C header", "no C compiler on the path", ratio=True)]
    calls = CALLS // 100 if quick else CALLS
    scene = yumi_arm()
    with tempfile.TemporaryDirectory() as folder:
        ours = _run_ours(compiler, Path(folder), scene, calls)
        theirs = {} if quick else _run_theirs(Path(folder), scene, calls)
    figures = []
    for name, (spent, _) in ours.items():
        beside = f"pinocchio C++ {theirs[name][0]:.3f}" if theirs else "pinocchio C++: not built"
        figures.append(Figure(f"{name}, us a call", f"{spent:.3f}", TARGETS[name], beside))
        if theirs:
            ratio = theirs[name][0] / spent
            figures.append(Figure(f"{name}, times faster than the peer", f"{ratio:.2f}", "", ratio=True))
    share = ours["inertia matrix"][0] / ours["inverse dynamics"][0]
    figures.append(Figure("inertia matrix over inverse dynamics", f"{share:.2f}", "", ratio=True))
    if theirs:
        for name in ("gravity", "inertia matrix"):
            gap = abs(ours[name][1] / theirs[name][1] - 1.0)
            figures.append(Figure(f"{name}, relative difference", f"{gap:.1e}", "<= 1e-12", ratio=True))
    return figures


def _run_ours(compiler: str, folder: Path, scene: Scene, calls: int) -> dict[str, tuple[float, float]]:
    kinds = ("individually",) * len(scene.truth)
    (folder / "robot.h").write_text(write_c_header(IdentifiedRobot(scene.model, scene.truth, kinds)))
    source = _OURS.replace("ROBOT", c_name(scene.robot.name))
    return _timed([compiler, "-O2"], folder / "ours.c", source, len(scene.robot.joints), calls, "-lm")


def _run_theirs(folder: Path, scene: Scene, calls: int) -> dict[str, tuple[float, float]]:
    """Build pinocchio's programme; nothing where it cannot be built."""
    compiler = shutil.which("c++")
    headers = next(
        (
            parent / "cmeel.prefix" / "include"
            for parent in Path(pinocchio.__file__).parents
            if (parent / "cmeel.prefix" / "include").is_dir()
        ),
        None,
    )
    if compiler is None or headers is None or not EIGEN.is_dir():
        return {}
    gravity = ", ".join(repr(float(one)) for one in scene.robot.gravity)
    source = _THEIRS.replace("GRAVITY", gravity).replace("BUILD", "\n".join(_built(scene)))
    command = [compiler, "-std=c++17", "-O2", "-DNDEBUG", *DEFINED, f"-I{headers}", f"-I{EIGEN}"]
    libraries = (f"-L{headers.parent / 'lib'}", f"-Wl,-rpath,{headers.parent / 'lib'}", "-lpinocchio_default")
    return _timed(command, folder / "theirs.cpp", source, len(scene.robot.joints), calls, *libraries)


def _built(scene: Scene) -> list[str]:
    """Write the lines that build pinocchio's model, body by body about its own centre of mass."""
    place = {
        parameter.name: value for parameter, value in zip(scene.model.parameters, scene.truth, strict=True)
    }
    lines = []
    for number, link in enumerate(scene.robot.links, start=1):
        mass = place[f"M{number}"]
        centre = np.array([place[f"M{axis}{number}"] for axis in "XYZ"]) / mass
        xx, xy, xz, yy, yz, zz = (place[f"{pair}{number}"] for pair in ("XX", "XY", "XZ", "YY", "YZ", "ZZ"))
        tensor = np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]])
        tensor -= mass * (centre @ centre * np.eye(3) - np.outer(centre, centre))
        joint = "RZ" if link.kind == "revolute" else "PZ"
        lines += [
            f"    turn << {_numbers(link.rotation)};",
            f"    inertia << {_numbers(tensor)};",
            (
                f"    model.addJoint({link.antecedent}, pinocchio::JointModel{joint}(), pinocchio::SE3(turn, "
                f'Eigen::Vector3d({_numbers(link.translation)})), "{number}");'
            ),
            (
                f"    model.appendBodyToJoint({number}, pinocchio::Inertia({float(mass)!r}, "
                f"Eigen::Vector3d({_numbers(centre)}), inertia));"
            ),
        ]
    return lines


def _numbers(values: np.ndarray) -> str:
    return ", ".join(repr(float(one)) for one in np.ravel(values))


def _timed(
    command: list[str], path: Path, source: str, joints: int, calls: int, *libraries: str
) -> dict[str, tuple[float, float]]:
    """Compile a programme and run it: per call its time, us, and the last number that it gave."""
    for name, count in (("@JOINTS", joints), ("@STATES", STATES), ("@CALLS", calls)):
        source = source.replace(name, str(count))
    path.write_text(source)
    subprocess.run([*command, "-o", str(path.with_suffix("")), str(path), *libraries], check=True)
    answer = subprocess.run([path.with_suffix("")], check=True, capture_output=True, text=True)
    rows = (line.partition(": ") for line in answer.stdout.splitlines())
    return {name: (float(rest.split()[0]), float(rest.split()[1])) for name, _, rest in rows}
