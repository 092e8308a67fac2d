"""Hold the public names: they exist, are explained, and load no more than they need."""

import subprocess
import sys
from importlib import import_module

import pytest

import veritorque


@pytest.mark.parametrize("name", sorted(veritorque.__all__))
def test_a_public_name_is_there_and_explained(name):
    assert getattr(veritorque, name).__doc__


def test_an_unknown_name_is_refused_with_the_list_of_known_ones():
    with pytest.raises(AttributeError, match="read_log"):
        veritorque.identfy  # noqa: B018  (the access is the test)


def test_reading_an_error_class_loads_neither_solver_nor_compiler():
    heavy = "{'numba', 'cvxpy', 'clarabel', 'scipy'}"
    code = f"import sys, veritorque.core.errors; print(sorted({heavy} & set(sys.modules)))"
    answer = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert answer.stdout.strip() == "[]"


def test_the_study_uses_the_same_objects_that_are_public():
    assert veritorque.identify is import_module("veritorque.core.study").identify
