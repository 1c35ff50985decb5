"""Every rule of a method has a unit and a reason."""

from __future__ import annotations

import sys

from lidar_buildings.algorithms.rules import rules_of
from lidar_buildings.algorithms.sampling import kinds
from lidar_buildings.algorithms.stages import STAGES
from lidar_buildings.algorithms.terrain import free_standing


def test_the_rules_of_a_module_are_its_own_with_unit_and_reason():
    rules = {name: (value, field) for name, value, field in rules_of(free_standing)}
    value, field = rules["FREE.step"]
    assert value == free_standing.FREE.step
    assert field.metadata["unit"] == "m"


def test_rules_that_differ_from_their_defaults_are_listed_as_they_are():
    rules = {name: value for name, value, _ in rules_of(kinds)}
    assert rules["LASER.foot"] == kinds.LASER.foot
    assert rules["IMAGES.foot"] == kinds.IMAGES.foot != kinds.LASER.foot


def test_every_rule_has_a_reason_and_a_unit_which_is_empty_for_plain_numbers():
    # A stage's module is imported when the stage is asked for.
    assert list(STAGES.values())
    rules = [
        rule for module in list(sys.modules.values()) if "algorithms" in module.__name__ for rule in rules_of(module)
    ]
    assert len(rules) > 100
    for name, _, field in rules:
        assert isinstance(field.metadata["unit"], str), name
        assert field.metadata["why"], name
        assert "|" not in field.metadata["why"], name
