"""Describe the document of an audit of a robot's description, and the request for one."""

from typing import Annotated, Literal

from pydantic import Field, JsonValue

from .common import HeldOutSpan, Identity, JointFit, Open, Options, Strict, about
from .conflicts import Conflict
from .robots import RobotDescription

EntryName = Literal["mass", "centre", "inertia"]


class AuditRequest(Strict):
    """A request to audit a robot's description."""

    logs: Annotated[list[Identity], Field(max_length=100)] = Field(
        default=[], description="logs to audit against; without any the description is audited by itself"
    )
    options: Options = Field(
        default={}, description="makers_mass (kg), and with logs the options of an identification"
    )


class BodyRemark(Open):
    """What is odd about a described body."""

    check: Annotated[str, Field(examples=["triangle_inequality"])]
    link: Annotated[int | None, about("counted from 1; null if it concerns the whole robot")]
    name: str | None
    entry: EntryName
    statement: str
    remedy: str


class DescribedEntry(Open):
    """An entry of the description."""

    link: int
    name: str
    entry: EntryName


class ContradictedEntry(DescribedEntry):
    """An entry that the logs contradict."""

    described: Annotated[
        list[float], about("mass; x, y, z of the centre; XX XY XZ YY YZ ZZ about the centre")
    ]
    corrected: list[float]
    unit: str
    chi_square: Annotated[float, about("by how much its correction lowers the misfit")]
    p_value: Annotated[float, about("corrected for the number of entries")]
    statement: str
    ambiguous_with: Annotated[list[DescribedEntry], about("entries that explain the logs as well")]


class Combination(Open):
    """An identifiable combination of the bodies' parameters, as described and as measured."""

    name: Annotated[str, Field(examples=["MXR2"])]
    joint: int
    unit: str
    grouping: str
    described: float
    measured: float | None
    standard_deviation: float | None
    slack: Annotated[float, about("by how much a sound description may be off")]
    deviations: Annotated[float | None, about("difference over both deviations together")]
    contradicted: bool


class TotalMass(Open):
    """The mass of the moving links together, and the robot's by its maker, kg."""

    described: float | None
    maker: float | None


class AuditDocument(Open):
    """Which bodies of a description are impossible, and which entries logs contradict."""

    schema_version: str
    kind: Literal["audit"]
    conflicts: list[Conflict]
    doubts: Annotated[list[str], about("warnings, as sentences; conflicts come first")]
    robot: RobotDescription
    bodies_described: bool
    total_mass: TotalMass
    remarks: Annotated[list[BodyRemark], about("what is odd about the description by itself")]
    logs: list[dict[str, JsonValue]]
    judged: Annotated[bool, about("whether logs were able to judge the entries")]
    not_judged_because: str | None
    contradicted: list[ContradictedEntry]
    combinations: list[Combination]
    corrected_robot: Annotated[
        RobotDescription | None, about("the description with its contradicted entries corrected")
    ]
    fit: list[JointFit] = Field(default=[])
    validation: list[JointFit] = Field(default=[])
    held_out: list[HeldOutSpan] = Field(default=[])
