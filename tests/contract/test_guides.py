"""Keep the guides true: examples are accepted, tables name what the code knows, links lead somewhere."""

import json
import re
from dataclasses import fields
from pathlib import Path

import pytest

from veritorque.app.problems import KINDS, URN
from veritorque.app.settings import PREFIX, Settings
from veritorque.core.dynamics.model import STANDARD_TERMS
from veritorque.core.estimate.methods.registry import ESTIMATORS
from veritorque.core.identification.options import parse_options
from veritorque.core.log.channels import CHANNELS, UNITS
from veritorque.core.log.columns.mapping import parse_mapping
from veritorque.core.log.formats.content import FORMS
from veritorque.core.log.model import Defect
from veritorque.core.robot.description import (
    COUPLING_FIELDS,
    JOINT_FIELDS,
    MODIFIED_DH,
    ROBOT_FIELDS,
    ROW_FIELDS,
    robot_from_description,
)
from veritorque.core.robot.plausibility import plausibility_warnings
from veritorque.core.robot.urdf.read import robot_from_urdf

ROOT = Path(__file__).parents[2]
GUIDES = [ROOT / "README.md", *sorted((ROOT / "docs").glob("*.md"))]
ROBOTS, LOGS, OPTIONS, HTTP, OPERATING = (
    (ROOT / "docs" / f"{name}.md").read_text(encoding="utf-8")
    for name in ("robots", "logs", "options", "http", "operating")
)


def blocks(text: str, language: str) -> list[str]:
    return [
        body
        for kind, body in re.findall(r"^```(\w*)\n(.*?)^```$", text, re.DOTALL | re.MULTILINE)
        if kind == language
    ]


def anchors(text: str) -> set[str]:
    headings = re.findall(r"^#+ (.+)$", text, re.MULTILINE)
    return {re.sub(r"[^\w -]", "", heading.lower()).replace(" ", "-") for heading in headings}


def table_names(text: str) -> set[str]:
    """Give the names in code spans in the first cell of every table row."""
    cells = re.findall(r"^\| *(`[^|]*`) *\|", text, re.MULTILINE)
    return {name for cell in cells for name in re.findall(r"`([^`]+)`", cell)}


@pytest.mark.parametrize("text", blocks(ROBOTS, "json"), ids=lambda text: json.loads(text)["name"])
def test_every_robot_of_the_guide_is_accepted_without_a_warning(text):
    assert plausibility_warnings(robot_from_description(json.loads(text))) == ()


def test_the_urdf_of_the_guide_is_accepted_and_its_inertials_become_the_belief():
    (text,) = blocks(ROBOTS, "xml")
    assert robot_from_urdf(text).prior is not None


def test_the_coupled_robot_of_the_guide_has_the_sixty_base_parameters_of_the_published_table():
    from veritorque.core.document.base_parameters import base_parameters

    (text,) = (text for text in blocks(ROBOTS, "json") if "couplings" in text)
    # Source: TX40_bp_5.csv of the data set behind Janot, Vandanjon & Gautier 2014; a count, hence exact.
    assert base_parameters(robot_from_description(json.loads(text)))["counts"]["base"] == 60


def test_every_field_of_a_description_is_explained():
    told = set(re.findall(r"`(\w+)`", ROBOTS)) | set(re.findall(r'"(\w+)":', ROBOTS))
    assert set(ROBOT_FIELDS) | set(JOINT_FIELDS) | set(ROW_FIELDS) | set(COUPLING_FIELDS) <= told
    assert f'"convention": "{MODIFIED_DH}"' in ROBOTS


def test_the_options_shown_as_defaults_are_the_defaults():
    (text,) = blocks(OPTIONS, "json")
    shown, default = parse_options(json.loads(text)), parse_options({})
    assert {one.name: getattr(shown, one.name) for one in fields(shown) if one.name != "given"} == {
        one.name: getattr(default, one.name) for one in fields(default) if one.name != "given"
    }


def test_every_option_shown_is_explained_and_every_option_explained_is_shown():
    (text,) = blocks(OPTIONS, "json")
    shown = set()
    for name, value in json.loads(text).items():
        shown |= {f"{name}.{inner}" for inner in value} if isinstance(value, dict) else {name}
    assert table_names(OPTIONS) == shown
    assert set(STANDARD_TERMS) | set(ESTIMATORS) <= set(re.findall(r"`(\w+)`", OPTIONS))


def test_the_units_and_names_of_the_guide_are_those_the_reader_knows():
    (table,) = re.findall(r"\| channel \| units \|\n\|---\|---\|\n(.*?)\n\n", LOGS, re.DOTALL)
    told = {row.split("|")[1].strip(): re.findall(r"`([^`]+)`", row) for row in table.splitlines()}
    assert told == {channel: list(units) for channel, units in UNITS.items()}
    assert all(f"`{channel.prefix}_1`" in LOGS for channel in CHANNELS.values() if channel.per_joint)
    assert all(any(media in LOGS for media in form.media_types) for form in FORMS)


def test_the_mapping_of_the_guide_is_understood():
    (text,) = re.findall(r"-F 'mapping=(.*?)'", LOGS, re.DOTALL)
    assert set(parse_mapping(json.loads(text)).channels) == {"time", "position", "torque"}


def test_every_kind_of_defect_is_explained():
    known = set(re.findall(r"\w+", (Defect.__doc__ or "").split("``")[1]))
    (table,) = re.findall(r"^\| kind \|.*?\n\n", LOGS, re.DOTALL | re.MULTILINE)
    assert table_names(table) == known


def test_every_setting_is_listed():
    assert {name.lower() for name in re.findall(PREFIX + r"(\w+)`", OPERATING)} == set(Settings.model_fields)


def test_problems_quoted_in_the_guides_are_of_kinds_that_exist():
    quoted = re.findall(URN + r"([\w-]+)", LOGS + HTTP)
    assert quoted
    assert set(quoted) <= set(KINDS)


@pytest.mark.parametrize("guide", GUIDES, ids=lambda path: path.name)
def test_every_link_inside_the_project_leads_somewhere(guide):
    for target in re.findall(r"\]\(([^)\s]+)\)", guide.read_text(encoding="utf-8")):
        if "://" in target:
            continue
        path, _, anchor = target.partition("#")
        file = guide.parent / path if path else guide
        assert file.exists(), target
        assert not anchor or anchor in anchors(file.read_text(encoding="utf-8")), target
