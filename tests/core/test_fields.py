"""Hold the reader of plain data: what is known is read exactly, everything else is refused with its place."""

from dataclasses import dataclass

import pytest
from hypothesis import given
from hypothesis import strategies as st

from veritorque.core.errors import OptionError
from veritorque.core.fields import Fields, scalar_meanings


@dataclass(frozen=True)
class Settings:
    """Scalars of every kind, and one field that is none."""

    rounds: int = 3
    share: float = 0.5
    cutoff: float | None = None
    strict: bool = False
    name: str = "plain"
    pairs: tuple[int, ...] = ()


class SettingFields(Fields):
    """Read settings."""

    error = OptionError


MEANINGS = scalar_meanings(Settings)
VALUES = {
    "rounds": st.integers(),
    "share": st.floats(-1e30, 1e30) | st.integers(-9, 9),
    "cutoff": st.floats(-1e30, 1e30),
    "strict": st.booleans(),
    "name": st.sampled_from(["a", "b c"]),
}


def settings_of(document: object) -> Settings:
    return SettingFields(document, "the settings", "/settings", MEANINGS).record(Settings(), pairs=(1,))


@given(st.fixed_dictionaries({}, optional=VALUES))
def test_a_record_holds_what_is_given_and_its_defaults_elsewhere(document):
    expected = {name: document.get(name, getattr(Settings(), name)) for name in MEANINGS}
    assert settings_of(document) == Settings(**expected, pairs=(1,))
    assert settings_of(document | dict.fromkeys(MEANINGS.keys() - document.keys())) == settings_of(document)


WRONG = {
    "rounds": [[], {}, "", b"", float("nan"), 2.5, True],
    "share": [[], {}, "0.5", float("nan"), float("inf"), 10**400, -1e31, True],
    "cutoff": [[], {}, "0.5", float("nan"), float("inf"), 10**400, -1e31, True],
    "strict": [[], {}, "true", 0, 1.0],
    "name": [[], {}, "", "  ", b"a", "a\nb", "a" * 101, 7, True],
}


@pytest.mark.parametrize(("name", "wrong"), [(name, wrong) for name in WRONG for wrong in WRONG[name]])
def test_a_value_of_another_kind_is_refused_with_its_place_and_what_it_must_be(name, wrong):
    with pytest.raises(OptionError) as caught:
        settings_of({name: wrong})
    assert caught.value.cause.startswith(f"the settings: {name} ")
    assert caught.value.evidence["pointer"] == f"/settings/{name}"
    assert caught.value.evidence["given"]
    assert caught.value.remedy == f"give {name} as {MEANINGS[name]}"


@given(st.integers(-(2**53), 2**53))
def test_a_whole_number_is_read_with_or_without_a_decimal_point(number):
    read = settings_of({"rounds": float(number)}).rounds
    assert (read, type(read)) == (number, int)


def test_an_unknown_field_is_answered_with_the_known_ones_and_the_nearest():
    with pytest.raises(OptionError) as caught:
        settings_of({"cut_off": 1.0})
    assert caught.value.evidence == {
        "pointer": "/settings",
        "unknown": ["cut_off"],
        "known": list(MEANINGS),
        "nearest": ["cutoff"],
    }
