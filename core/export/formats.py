"""List the files in which an identified robot leaves: one name, one media type, one writer each.

Whoever has a result document writes any of them by `FORMATS[name].write(document)`.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

from core.export.c_header import write_c_header
from core.export.identified import IdentifiedRobot
from core.export.matlab import write_matlab
from core.export.mjcf import write_mjcf
from core.export.model_file import write_model
from core.export.reading import identified_model, identified_robot
from core.export.sdf import write_sdf
from core.export.tables import base_parameter_table, standard_parameter_table
from core.export.urdf import write_urdf
from core.export.yaml import write_yaml

Document = Mapping[str, Any]


@dataclass(frozen=True)
class Format:
    """Describe one file: its media type, what it is in a few words, and how a result is written as it."""

    media_type: str
    title: str
    write: Callable[[Document], bytes]


def _text(write: Callable[[Document], str]) -> Callable[[Document], bytes]:
    return lambda document: write(document).encode()


def _robot(write: Callable[[IdentifiedRobot], str]) -> Callable[[Document], bytes]:
    return _text(lambda document: write(identified_robot(document)))


FORMATS: Mapping[str, Format] = {
    "parameters.csv": Format("text/csv", "base parameters", _text(base_parameter_table)),
    "standard_parameters.csv": Format("text/csv", "standard parameters", _text(standard_parameter_table)),
    "parameters.yaml": Format("application/yaml", "robot and parameters as YAML", _robot(write_yaml)),
    "parameters.mat": Format(
        "application/x-matlab-data",
        "robot and parameters for MATLAB",
        lambda document: write_matlab(identified_robot(document)),
    ),
    "parameters.h": Format("text/x-c", "inverse dynamics in C", _robot(write_c_header)),
    "robot.urdf": Format("application/xml", "URDF", _robot(write_urdf)),
    "robot.xml": Format("application/xml", "MJCF, for MuJoCo", _robot(write_mjcf)),
    "robot.sdf": Format("application/xml", "SDFormat, for Gazebo", _robot(write_sdf)),
    "model.json": Format(
        "application/json",
        "the whole model, extended or not, to be loaded again",
        _text(lambda document: write_model(identified_model(document))),
    ),
}
"""All files by name."""
