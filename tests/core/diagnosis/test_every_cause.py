"""Hold every cause to the same contract, found by listing the files of `core/diagnosis/causes`.

Nothing here depends on which causes there are, but for the public enumeration: taking an id out of it, or
putting one in, changes what users were promised.
"""

import inspect
import re
from dataclasses import replace
from importlib import import_module
from pathlib import Path

import numpy as np
import pytest

from tests.core.diagnosis.scenes import (
    UNTOUCHED,
    Scene,
    change_with_measurement,
    eventful_scene,
    first_choice,
    recording,
    scene_of,
    spoilt_scenes,
)
from tests.plant.effects.registry import PARAMETERS
from veritorque.core.diagnosis.causes.imitation import imitations
from veritorque.core.diagnosis.causes.masking import excludes, masks
from veritorque.core.diagnosis.causes.protocol import Cause, FittedCause, Setting
from veritorque.core.diagnosis.causes.registry import AGAINST_REFERENCE, BY_ID, CAUSES, SAMPLE_CHECKS
from veritorque.core.diagnosis.causes.repairs import CorrectsLog, CorrectsRobot, corrects
from veritorque.core.diagnosis.causes.sample_check import SampleCheck
from veritorque.core.diagnosis.checks.figure import STAND_IN
from veritorque.core.diagnosis.residual.coordinates import coordinate, coordinate_names
from veritorque.core.log.model import whole_rows
from veritorque.core.robot.differences import differences
from veritorque.core.robot.inertia import from_mass_properties

FOLDER = Path(__file__).parents[3] / "core" / "diagnosis" / "causes"
SHARED_PARTS = {
    "__init__",
    "guide",
    "exclusion",
    "imitation",
    "masking",
    "protocol",
    "registry",
    "repairs",
    "sample_check",
    "traits",
}
FILES = sorted({path.stem for path in FOLDER.glob("*.py")} - SHARED_PARTS)
PUBLIC = {*PARAMETERS, "friction_change", "link_parameters"}
VERDICTS_NOT_CAUSES = {"none", "unexplained", "ambiguous"}
ODD_UNITS = {"ms", "%", "N m per N m", "cycles per revolution"}
"""How a sentence may write s, a share, a ratio and a harmonic."""

BALL = from_mass_properties(1.0, np.array([0.1, 0.2, 0.3]), 0.01 * np.eye(3))
"""Ten equal numbers are no body."""

every_cause = pytest.mark.parametrize("cause", BY_ID.values(), ids=BY_ID)
every_sample_check = pytest.mark.parametrize("cause", SAMPLE_CHECKS, ids=lambda one: one.id)
every_torque_cause = pytest.mark.parametrize("cause", AGAINST_REFERENCE, ids=lambda one: one.id)


@pytest.fixture(scope="module")
def scene() -> Scene:
    return eventful_scene()


@pytest.fixture(scope="module")
def parked() -> Scene:
    """Prepare a log whose second joint rests at exactly zero while the others move."""
    time, position, torque = recording()
    position[:, 1] = 0.0
    return scene_of(time, position, torque)


@every_torque_cause
def test_a_joint_that_never_moves_leaves_every_cause_with_finite_columns(cause, parked):
    for site in cause.sites(parked.dataset):
        for scalars in cause.grid(Setting(parked.dataset, parked.operating_point, site)):
            (columns,) = parked.dataset.columns(
                [cause.term(Setting(parked.dataset, parked.operating_point, site, scalars))]
            )
            assert all(np.isfinite(one).all() for one in columns.values())


def solved(cause: Cause, scene: Scene, value: float) -> FittedCause:
    """Give all linear parameters at the cause's first site the same value, known to a fifth."""
    site, scalars = first_choice(cause, scene)
    count = len(
        cause.term(Setting(scene.dataset, scene.operating_point, site, scalars)).parameters(
            scene.dataset.robot
        )
    )
    covariance = (0.2 * value) ** 2 * np.eye(count) if np.isfinite(value) else np.eye(count)
    return FittedCause(site, np.full(count, value), covariance, scalars, dict.fromkeys(scalars, 0.1))


def base_name(name: str) -> str:
    """Take the number off a quantity of which there are several: start_2 is a start."""
    return re.sub(r"_\d+$", "", name)


def causes_of_file(stem: str) -> list[type]:
    module = import_module(f"veritorque.core.diagnosis.causes.{stem}")
    return [
        one
        for _, one in inspect.getmembers(module, inspect.isclass)
        if one.__module__ == module.__name__ and hasattr(one, "id")
    ]


@pytest.mark.parametrize("stem", FILES)
def test_a_file_of_causes_holds_one_cause_of_its_own_name_and_the_registry_has_it(stem):
    (kind,) = causes_of_file(stem)
    assert kind.id == stem
    assert kind.__name__ == "".join(word.capitalize() for word in stem.split("_"))
    assert type(BY_ID[stem]) is kind


def test_the_registry_has_no_cause_twice_and_none_without_a_file():
    listed = [one.id for one in (*CAUSES, *SAMPLE_CHECKS)]
    assert len(set(listed)) == len(listed)
    assert sorted(BY_ID) == FILES


def test_the_causes_are_the_published_ones():
    assert set(BY_ID) == PUBLIC
    assert not set(BY_ID) & VERDICTS_NOT_CAUSES


@every_cause
def test_a_cause_states_what_it_is_what_it_corrects_and_what_would_show_it(cause):
    assert cause.title[0].isupper()
    assert not cause.title.endswith(".")
    assert cause.cure in ("term", "signal", "robot")
    assert len(cause.experiment) > 20
    assert inspect.getdoc(inspect.getmodule(cause)).startswith("Candidate cause: ")


@every_cause
def test_a_cause_names_its_numbers_once_each_with_a_unit(cause):
    names = [name for name, _ in cause.units]
    assert names
    assert len(set(names)) == len(names)
    assert all(unit for _, unit in cause.units)


@every_cause
def test_an_imitation_names_another_known_cause_why_and_an_experiment(cause):
    assert imitations(cause.id)
    for other, entry in imitations(cause.id).items():
        assert other in set(BY_ID) - {cause.id}
        assert len(entry.why) > 20
        assert len(entry.experiment) > 20


@every_torque_cause
def test_a_cause_is_shown_over_a_coordinate_that_there_is(cause, scene):
    name = STAND_IN.get(cause.coordinate, cause.coordinate)
    if name == "other_velocity":
        name = "velocity_of_joint_2"
    assert name in coordinate_names(scene.dataset)
    assert coordinate(scene.dataset, scene.operating_point, name, 1) is not None


@every_torque_cause
def test_sites_are_joints_of_the_robot_each_named_once(cause, scene):
    sites = cause.sites(scene.dataset)
    assert sites
    assert len(set(sites)) == len(sites)
    assert all(1 <= joint <= scene.dataset.joints for site in sites for joint in site)


def test_terms_of_different_causes_and_sites_have_different_names_so_that_none_replaces_another(scene):
    dataset, operating_point = scene.dataset, scene.operating_point
    names = [
        cause.term(
            Setting(dataset, operating_point, site, cause.grid(Setting(dataset, operating_point, site))[0])
        ).name
        for cause in CAUSES
        for site in cause.sites(dataset)
    ]
    assert len(set(names)) == len(names)


@every_torque_cause
def test_a_grid_has_finite_scalars_of_the_same_names_each_point_once(cause, scene):
    for site in cause.sites(scene.dataset):
        grid = cause.grid(Setting(scene.dataset, scene.operating_point, site))
        assert grid
        assert len({frozenset(one.items()) for one in grid}) == len(grid)
        assert {frozenset(one) for one in grid} == {frozenset(grid[0])}
        assert all(np.isfinite(value) for one in grid for value in one.values())


@every_torque_cause
def test_a_point_of_a_grid_was_picked_from_at_least_all_of_it(cause, scene):
    site, scalars = first_choice(cause, scene)
    grid = cause.grid(Setting(scene.dataset, scene.operating_point, site))
    assert len(grid) <= cause.traits.trials(grid, scalars) < np.inf


@every_torque_cause
def test_what_a_cause_masks_or_excludes_is_another_that_a_search_could_add(cause, scene):
    """It may mask itself only where it could be at another joint, too."""
    others = {one.id for one in CAUSES} - {cause.id}
    elsewhere = {cause.id} if len(cause.sites(scene.dataset)) > 1 else set()
    assert set(excludes(cause.id)) <= others
    assert set(masks(cause.id)) <= others | elsewhere


@every_torque_cause
def test_causes_that_exclude_each_other_imitate_each_other(cause):
    """What only one of the two excludes resembles the remainder of its own columns."""
    mutual = {name for name in excludes(cause.id) if cause.id in excludes(name)}
    assert mutual <= set(imitations(cause.id))


@every_torque_cause
def test_a_scan_gives_finite_columns_of_one_width_that_are_not_all_nothing(cause, scene):
    dataset, operating_point = scene.dataset, scene.operating_point
    site = cause.sites(dataset)[-1]
    grid = cause.grid(Setting(dataset, operating_point, site))
    terms = [cause.term(Setting(dataset, operating_point, site, scalars)) for scalars in grid]
    widths = {len(term.parameters(dataset.robot)) for term in terms}
    assert len(widths) == 1
    for columns in dataset.columns(terms):
        assert columns
        assert set(columns) <= set(range(dataset.joints))
        for column in columns.values():
            assert column.shape == (len(dataset.time), *widths)
            assert np.isfinite(column).all()
    assert any(np.abs(column).max() > 0.0 for one in dataset.columns(terms) for column in one.values())


@every_torque_cause
def test_columns_come_from_the_prediction_and_not_from_the_measured_torque(cause, scene):
    assert change_with_measurement(cause, scene) < UNTOUCHED


@every_torque_cause
@pytest.mark.parametrize("value", [np.nan, np.inf, -np.inf])
def test_an_estimate_that_is_not_finite_is_not_admissible(cause, scene, value):
    assert not cause.admissible(solved(cause, scene, value))


@every_torque_cause
def test_some_size_is_admissible(cause, scene):
    sizes = [sign * 10.0**power for power in range(-6, 2) for sign in (1.0, -1.0)]
    found = [solved(cause, scene, size) for size in sizes]
    if len(found[0].values) == len(BALL):
        found += [replace(one, values=one.values * BALL) for one in found]
    assert any(cause.admissible(one) for one in found)


@every_torque_cause
def test_the_numbers_of_a_finding_are_those_announced_with_unit_and_deviation(cause, scene):
    found = cause.quantities(solved(cause, scene, 1e-3))
    announced = {name: unit.split(" or ") for name, unit in cause.units}
    assert len({one.name for one in found}) == len(found) > 0
    for one in found:
        assert one.unit in announced[base_name(one.name)]
        assert np.isfinite(one.value)
        assert one.standard_deviation >= 0.0


@every_torque_cause
def test_a_finding_is_one_sentence_that_names_the_joint_and_a_number_with_its_unit(cause, scene):
    found = solved(cause, scene, 1e-3)
    text = cause.statement(found)
    units = {one.unit for one in cause.quantities(found)} - {"1"} | ODD_UNITS
    assert text[0].isupper()
    assert not text.endswith(".")
    assert len(text) < 240
    assert not re.search(r"nan|inf\b|\d\.?\d*e\+", text)
    assert re.search(r"\d ± [\d.e-]+ ", text)
    assert any(unit in text for unit in units) or "times" in text
    if found.site:
        assert re.search(rf"[Jj]oints? (\d and )?{max(found.site)}\b", text)


def repair_of(cause: Cause, scene: Scene) -> tuple[tuple[int, ...], dict[str, float]]:
    """Give joints and numbers of a small finding."""
    found = solved(cause, scene, 1e-3)
    joints = found.site or tuple(range(1, scene.dataset.joints + 1))
    return joints, dict(cause.numbers(scene.dataset, found))


@every_torque_cause
def test_a_repair_is_one_sentence_from_numbers_that_a_document_can_hold(cause, scene):
    joints, numbers = repair_of(cause, scene)
    text = cause.repair(scene.dataset.robot, joints, numbers)
    assert text[0].isupper()
    assert not text.endswith(".")
    assert len(text) < 240
    assert not re.search(r"nan|inf\b|\d\.?\d*e\+", text)
    assert all(np.isfinite(value) for value in numbers.values())
    assert corrects(cause) == "model" or re.search(r"\d", text)


@every_torque_cause
def test_a_repair_changes_what_it_says_and_can_be_done_from_the_numbers_alone(cause, scene):
    joints, numbers = repair_of(cause, scene)
    robot, (motion,) = scene.dataset.robot, scene.dataset.motions
    assert corrects(cause) in ("robot", "log", "model")
    if isinstance(cause, CorrectsRobot):
        assert differences(robot, cause.corrected_robot(robot, joints, numbers))
    if isinstance(cause, CorrectsLog):
        rows = whole_rows(motion.log)
        corrected = cause.corrected_rows(rows, joints, numbers)
        changed = [
            np.abs(corrected.torque - rows.torque).max(),
            np.abs(corrected.position - rows.position).max(),
        ]
        assert np.isfinite(changed).all()
        assert max(changed) > 0.0
        np.testing.assert_array_equal(corrected.time, rows.time)


@every_sample_check
def test_a_fault_of_the_samples_states_why_no_log_can_be_corrected_for_it(cause: SampleCheck):
    assert cause.beyond_repair[0].isupper()
    assert not cause.beyond_repair.endswith(".")
    assert len(cause.beyond_repair.split()) > 5


@every_sample_check
def test_a_fault_of_the_samples_is_found_where_it_is_and_not_in_samples_without_one(cause: SampleCheck):
    clean = eventful_scene()
    assert cause.examine(clean.dataset, clean.operating_point) == ()
    announced = dict(cause.units)
    found = [
        one for spoilt in spoilt_scenes() for one in cause.examine(spoilt.dataset, spoilt.operating_point)
    ]
    assert found
    for one in found:
        assert re.search(r"\d", one.statement)
        assert 0.0 <= one.p_value < 1e-4
        assert np.isfinite(one.residual_share).all()
        assert all(part.unit == announced[part.name] for part in one.quantities)
        assert all(part.standard_deviation >= 0.0 for part in one.quantities)
