"""Rules of the methods: numbers that a module groups under a name, each with its unit and the reason for it."""

import dataclasses
from collections.abc import Iterator
from typing import Any


def rule(value: Any, unit: str, why: str) -> Any:
    """Return a field of :func:`rules`: its value, the unit, and why it is so large."""
    return dataclasses.field(default=value, metadata={"unit": unit, "why": why})


def rules(declared: type) -> Any:
    """Return the rules that a class declares, for its name: fields that nothing changes while it runs.

    Examples
    --------
    >>> @rules
    ... class EAVES:
    ...     step: float = rule(1.0, "m", "physics: lower than any eave")
    >>> EAVES.step
    1.0
    >>> [(one.name, one.metadata["unit"]) for one in dataclasses.fields(EAVES)]
    [('step', 'm')]
    """
    frozen: Any = dataclasses.dataclass(frozen=True)(declared)
    return frozen()


def rules_of(module: Any) -> Iterator[tuple[str, Any, dataclasses.Field]]:
    """Yield name, value and field of each rule of a module: the fields of a dataclass that it names in capitals."""
    for name, value in vars(module).items():
        is_own = dataclasses.is_dataclass(value) and type(value).__module__ == module.__name__
        if is_own and not isinstance(value, type):
            for field in dataclasses.fields(value):
                if "why" in field.metadata:
                    yield f"{name}.{field.name}", getattr(value, field.name), field
