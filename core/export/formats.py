"""List the files in which an identified robot leaves: one name, one media type, one writer each.

Whoever has a result document writes any of them by `FORMATS[name].write(document)`. Writers are imported when
they write, so that the list itself costs nothing.
"""

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

from .tables import base_parameter_table, standard_parameter_table

Document = Mapping[str, Any]


@dataclass(frozen=True)
class Format:
    """Describe one file: its media type, what it is in a few words, and how a result is written as it.

    Writers raise `OptionError` where the result has no bodies, or bodies that simulators refuse, and
    `RobotError` where the format cannot say how the robot moves.
    """

    media_type: str
    title: str
    write: Callable[[Document], bytes]


def _base_csv(document: Document) -> bytes:
    return base_parameter_table(document).encode()


def _standard_csv(document: Document) -> bytes:
    return standard_parameter_table(document).encode()


def _yaml(document: Document) -> bytes:
    from ..document.model.reading import identified_robot
    from .yaml import write_yaml

    return write_yaml(identified_robot(document)).encode()


def _matlab(document: Document) -> bytes:
    from ..document.model.reading import identified_robot
    from .matlab import write_matlab

    return write_matlab(identified_robot(document))


def _c_header(document: Document) -> bytes:
    from ..document.model.reading import identified_robot
    from .c_header import write_c_header

    return write_c_header(identified_robot(document)).encode()


def _urdf(document: Document) -> bytes:
    from ..document.model.reading import identified_robot
    from .urdf import write_urdf

    return write_urdf(identified_robot(document)).encode()


def _mjcf(document: Document) -> bytes:
    from ..document.model.reading import identified_robot
    from .mjcf import write_mjcf

    return write_mjcf(identified_robot(document)).encode()


def _sdf(document: Document) -> bytes:
    from ..document.model.reading import identified_robot
    from .sdf import write_sdf

    return write_sdf(identified_robot(document)).encode()


def _model(document: Document) -> bytes:
    from ..document.model.model_file import write_model
    from ..document.model.reading import identified_model

    return write_model(identified_model(document)).encode()


FORMATS: Mapping[str, Format] = {
    "parameters.csv": Format("text/csv", "base parameters", _base_csv),
    "standard_parameters.csv": Format("text/csv", "standard parameters", _standard_csv),
    "parameters.yaml": Format("application/yaml", "the robot and its parameters", _yaml),
    "parameters.mat": Format("application/x-matlab-data", "the same for MATLAB", _matlab),
    "parameters.h": Format("text/x-c", "inverse dynamics in C", _c_header),
    "robot.urdf": Format("application/xml", "URDF", _urdf),
    "robot.xml": Format("application/xml", "MJCF, for MuJoCo", _mjcf),
    "robot.sdf": Format("application/xml", "SDFormat, for Gazebo", _sdf),
    "model.json": Format("application/json", "the complete model, for a later job", _model),
}
"""All files by name."""
