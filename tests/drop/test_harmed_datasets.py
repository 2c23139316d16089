"""Functions that take a Dataset of ours refuse one that was harmed, in our words, or give a result."""

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from reference.harmed import every_harm, harm, takers


@pytest.mark.filterwarnings("ignore::restitution.DistanceWarning")
@pytest.mark.parametrize("name", list(takers()))
@settings(max_examples=12)
@given(st.data())
def test_every_function_that_takes_one(name: str, data: st.DataObject) -> None:
    """Drawn from the catalogue, of all public functions; `make hostile` goes through all of it."""
    assert harm(name, data.draw(st.sampled_from(list(every_harm(name))))) is None


def test_a_mass_is_one_number() -> None:
    assert harm("resting", "attribute mass three") is None
