"""The classes of bodies, laws and materials are those that the core describes, parameter by parameter."""

from typing import Any

import pytest
from pydantic.fields import FieldInfo

from restitution import _core, bodies, laws

FAMILIES = (
    ((*bodies.KINDS, *bodies.RIGID[:-1]), _core.BODIES),
    (laws.KINDS, _core.LAWS),
    (laws.MATERIALS, _core.MATERIALS),
)
KINDS = [
    pytest.param(kind, entry, id=kind.__name__)
    for kinds, table in FAMILIES
    for kind, entry in zip(kinds, table, strict=True)
]


def bounds(field: FieldInfo) -> dict[str, Any]:
    """The ends of the interval that a field of a class allows, those that it says."""
    said = {}
    for constraint in field.metadata:
        for end in ("gt", "ge", "le"):
            if (value := getattr(constraint, end, None)) is not None:
                said[end] = value
    return said


@pytest.mark.parametrize(("kind", "entry"), KINDS)
def test_a_class_has_the_parameters_that_the_core_describes(kind: type[Any], entry: dict[str, Any]) -> None:
    """Names, order and defaults are the same; so are the ends of intervals, where the class has numbers."""
    assert kind.__name__ == entry["name"]
    fields = dict(kind.model_fields)
    if issubclass(kind, laws.Law):
        del fields["normal"]  # all laws have it, and it is no parameter of the rule
    described = {parameter["name"]: parameter for parameter in entry["parameters"]}
    assert list(fields) == list(described) or issubclass(kind, bodies.RigidBody)
    assert set(fields) == set(described)
    for name, field in fields.items():
        about = described[name]
        assert field.is_required() == ("default" not in about)
        if not field.is_required():
            assert field.default == about["default"]
        if about["type"] != "number" or name in ("normal", "heights"):  # which may be something else, too
            continue
        said = bounds(field)
        assert said.get("ge", said.get("gt")) == about["low"]
        assert ("ge" in said) == about["closed"]
        assert said.get("le", float("inf")) == about["high"]


def test_the_warning_names_the_laws_that_cannot_create_energy() -> None:
    from restitution.drop.energy import WHY

    for entry in _core.LAWS:
        assert (entry["name"] in WHY) == (entry["creates_energy"] is not True)
        if isinstance(entry["creates_energy"], tuple):
            parameter, value = entry["creates_energy"]
            assert parameter in WHY
            assert f"'{value}'" not in WHY
