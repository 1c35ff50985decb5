"""Tunables as Processing parameters: label, unit, bounds, choices, default and help from one declaration."""

from decimal import Decimal
from typing import Any, Optional

from qgis.core import (
    Qgis,
    QgsProcessingParameterBoolean,
    QgsProcessingParameterDefinition,
    QgsProcessingParameterEnum,
    QgsProcessingParameterNumber,
    QgsProcessingParameterString,
)

from ..algorithms.stage import Stage, Tunable, with_unit
from .given import Given

_NUMBERS = {float: Qgis.ProcessingNumberParameterType.Double, int: Qgis.ProcessingNumberParameterType.Integer}


def parameter_name(tunable: Tunable) -> str:
    """Return the parameter's name, ``CELL_SIZE`` of ``cell_size``."""
    return tunable.name.upper()


def used_name(tunable: Tunable) -> str:
    """Return the name of the output that holds the value that an automatic tunable took, ``CELL_SIZE_USED``."""
    return f"{parameter_name(tunable)}_USED"


def label(tunable: Tunable) -> str:
    """Return the label with its unit, and the meaning of an empty field where it may be empty."""
    facts = [tunable.param.unit] if tunable.param.unit else []
    if tunable.is_optional:
        facts.append(f"empty = {tunable.param.unset}")
    return f"{tunable.label} ({', '.join(facts)})" if facts else tunable.label


def help_text(tunable: Tunable) -> str:
    """Return the tooltip: what the tunable does, its range, what automatic means."""
    parts = [tunable.param.help]
    if tunable.param.bounds:
        parts.append(f"Range: {tunable.param.bounds}.")
    if tunable.is_optional:
        parts.append(tunable.param.unset_text)
    return " ".join(parts)


def parameter(tunable: Tunable) -> QgsProcessingParameterDefinition:
    """Return the Processing parameter of a tunable."""
    definition = _MAKERS[tunable.type](tunable, parameter_name(tunable), label(tunable))
    if tunable.param.advanced:
        definition.setFlags(definition.flags() | Qgis.ProcessingParameterFlag.Advanced)
    definition.setHelp(help_text(tunable))
    return definition


def _number(tunable: Tunable, name: str, title: str) -> QgsProcessingParameterDefinition:
    kind = _NUMBERS[tunable.type]
    definition = QgsProcessingParameterNumber(name, title, kind, tunable.default, tunable.is_optional)
    # QGIS has inclusive bounds only: the dialog takes an open bound too, the core refuses it.
    if tunable.param.low is not None:
        definition.setMinimum(tunable.param.low)
    if tunable.param.high is not None:
        definition.setMaximum(tunable.param.high)
    if tunable.type is float:
        definition.setMetadata({"widget_wrapper": {"decimals": _decimals(tunable)}})
    return definition


def _decimals(tunable: Tunable) -> int:
    """Return the number of decimals of the spin box for the default and the bounds, at least 3."""
    numbers = (tunable.default, tunable.param.low, tunable.param.high)
    exponents = [Decimal(repr(float(number))).as_tuple().exponent for number in numbers if number is not None]
    return max([3, *(-exponent for exponent in exponents if isinstance(exponent, int))])


def _boolean(tunable: Tunable, name: str, title: str) -> QgsProcessingParameterDefinition:
    return QgsProcessingParameterBoolean(name, title, tunable.default, tunable.is_optional)


def _word(tunable: Tunable, name: str, title: str) -> QgsProcessingParameterDefinition:
    if tunable.param.choices:
        return _enum(tunable, name, title)
    return QgsProcessingParameterString(name, title, tunable.default, optional=not tunable.default)


def _enum(tunable: Tunable, name: str, title: str) -> QgsProcessingParameterDefinition:
    choices, several = list(tunable.param.choices), tunable.type is tuple
    default = list(tunable.default) if several and tunable.default is not None else tunable.default
    # Static strings: a saved model keeps the word, not its position in today's list.
    return QgsProcessingParameterEnum(
        name,
        title,
        choices,
        allowMultiple=several,
        defaultValue=default,
        optional=tunable.is_optional,
        usesStaticStrings=True,
    )


_MAKERS = {float: _number, int: _number, bool: _boolean, str: _word, tuple: _enum}


def automatic_numbers(stage: Stage) -> list:
    """Return the automatic tunables of a stage that are numbers."""
    return [t for t in stage.tunables.values() if t.is_optional and t.type in (int, float)]


def number_outputs(stage: Stage) -> dict[str, str]:
    """Return names and titles of the numbers that a run gives: measures, and what automatic tunables took."""
    numbers = {measure.name.upper(): with_unit(measure.title, measure.unit) for measure in stage.measures}
    for tunable in automatic_numbers(stage):
        numbers[used_name(tunable)] = f"{tunable.title}, as used"
    return numbers


def tunable_values(
    given: Given, stage: Stage, named: Optional[dict[str, str]] = None, defaults: Optional[dict[str, Any]] = None
) -> dict[str, Any]:
    """Return the values of a stage's tunables, checked.

    ``named`` gives other parameters' names; ``defaults`` are a step's, which take the place of the stage's own.

    Raises
    ------
    ValueError
        In the words of the core, when a value is of the wrong kind or out of bounds; it names the parameter.
    """
    names = named or {name: parameter_name(tunable) for name, tunable in stage.tunables.items()}
    values = {name: tunable.default for name, tunable in stage.tunables.items()} | (defaults or {})
    for name, tunable in stage.tunables.items():
        if is_given(given.parameters.get(names[name])):
            values[name] = _value(given, tunable, names[name])
    return {name: tunable.check(values[name], names[name]) for name, tunable in stage.tunables.items()}


def is_given(raw: Any) -> bool:
    """Whether a parameter has a value: QGIS passes an empty number as None, as NULL or as empty text."""
    return not (raw is None or raw == "" or (hasattr(raw, "isNull") and raw.isNull()))


def _value(given: Given, tunable: Tunable, name: str) -> Any:
    raw = given.parameters[name]
    if tunable.type is tuple:
        words = raw if isinstance(raw, (list, tuple)) else given.read("String", name).split(",")
        return tuple(str(word).strip() for word in words if str(word).strip())
    if tunable.type is bool:
        return given.read("Bool", name)
    text = str(raw) if isinstance(raw, (int, float)) else given.read("String", name)
    return text if tunable.type is str else _number_of(text)


def _number_of(text: str) -> Any:
    """Return the number that ``text`` writes, or the text itself, which the core then refuses in its own words."""
    try:
        return float(text)
    except ValueError:
        return text
