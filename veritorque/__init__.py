"""Identify the dynamics of a robot from its log, and diagnose what its simulation gets wrong.

This is the one name in an environment; `core` holds the science and `app` the service. The public names are
found here and loaded when first used, so that reading an error class compiles no kernel.
"""

from importlib import import_module

_HOMES = {
    "Client": "app.client.client",
    "IdentifyRequest": "core.study",
    "JointLog": "core.log.model",
    "Result": "app.client.result",
    "RobotModel": "core.robot.model",
    "VeritorqueError": "core.errors",
    "base_parameters": "core.document.base_parameters",
    "builtin_robot": "core.robot.builtin",
    "builtin_robots": "core.robot.builtin",
    "diagnose": "core.study",
    "identified_robot": "core.document.model.reading",
    "identify": "core.study",
    "log_from_arrays": "core.log.reader",
    "parse_options": "core.identification.options",
    "read_log": "core.log.reader",
    "read_model": "core.document.model.model_file",
    "read_repairs": "core.document.repairs",
    "repaired_log": "core.extension.repaired_log",
    "repaired_robot": "core.extension.repair",
    "robot_from_description": "core.robot.description",
    "robot_from_urdf": "core.robot.urdf.read",
    "to_description": "core.robot.writing",
    "urdf_with_inertials": "core.export.urdf_in_place",
}

__all__ = list(_HOMES)


def __getattr__(name: str) -> object:
    if name not in _HOMES:
        message = f"veritorque has no public name {name!r}; it has {', '.join(sorted(_HOMES))}"
        raise AttributeError(message)
    return getattr(import_module(f"{__name__}.{_HOMES[name]}"), name)


def __dir__() -> list[str]:
    return sorted(_HOMES)
