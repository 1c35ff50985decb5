"""Help of an algorithm as HTML, from the declaration of its stage or pipeline."""

import html
import re
from collections.abc import Iterable
from typing import Optional

from .captions import captions
from .cloud.dimensions import DIMENSIONS
from .pipeline import Output, Pipeline, Step
from .stage import CLOUD, REFERENCE_PREFIX, VALUES, InputLayer, Layer, Raster, Stage, TextFile, Tunable, with_unit


def stage_help(stage: Stage) -> str:
    """Return everything that is known of a stage, as HTML that QGIS's help pane shows."""
    parts = [paragraphs(stage.summary), paragraphs(stage.description), _dimensions(stage)]
    parts.append(_list("Parameters", [tunable_help(tunable) for tunable in stage.tunables.values()]))
    parts.append(_list("Outputs", outputs(stage)))
    parts += [_section(title, stage.section(title)) for title in ("Notes", "References")]
    return "\n".join(filter(None, parts))


def pipeline_help(pipeline: Pipeline, made: Optional[list[str]] = None) -> str:
    """Return the help of a pipeline, step by step, with the parameters of its steps.

    ``made`` are texts of the outputs, where they differ from a run on one cloud.
    """
    named = [(step_title(step), step.stage) for step in pipeline.steps]
    steps = [f"<b>{title}</b> ({html.escape(stage.title)}): {inline(stage.summary)}" for title, stage in named]
    parts = [paragraphs(pipeline.summary), paragraphs(pipeline.description), _list("Steps", steps, ordered=True)]
    rows: dict[str, list] = {"Parameters": [], **{f"Parameters: {title}": [] for title, _ in named}}
    for name, (step, tunable) in pipeline.parameters.items():
        section = "Parameters" if name in pipeline.shared else f"Parameters: {step_title(step)}"
        rows[section].append(tunable_help(tunable, step.tunables.get(tunable.name, tunable.default)))
    parts += [_list(title, items) for title, items in rows.items()]
    parts.append(_list("Layers", list(map(input_layer_text, pipeline.input_layers.values()))))
    if pipeline.compared is not None:
        parts.append(_list("Second cloud", [f"<b>REFERENCE</b>: {inline(pipeline.compared.reference)}"]))
    if made is None:
        in_order = sorted(pipeline.outputs, key=lambda output: output.name != "output")
        made = [output_text(pipeline, output) for output in in_order]
    parts += [_list("Outputs", made), _section("References", pipeline.references)]
    return "\n".join(filter(None, parts))


def output_text(pipeline: Pipeline, output: Output) -> str:
    """Describe one output of a composite, as HTML."""
    name, stage = output.name.upper(), output.step.stage
    if output.name == "output":
        return f"<b>{name}</b>: the cloud with {written_by(pipeline)}."
    if output.of == "output":
        return f"<b>{name}</b>: the cloud as the step {step_title(output.step)} leaves it."
    return _result_text(stage, output.of, name)


def written_by(pipeline: Pipeline) -> str:
    """Return the dimensions that the steps of a composite write, by their names in files."""
    written = [(step.stage, name) for step in pipeline.steps for name in _written(step)]
    always = dict.fromkeys(name for stage, name in written if name not in stage.written_if)
    return _with_conditions(always, {name: stage.written_if[name] for stage, name in written if name not in always})


def _written(step: Step) -> tuple[str, ...]:
    """Return the dimensions that a step writes with nothing set, where the user chooses among its stage's."""
    chosen = _chosen(step.stage)
    return step.stage.writes if chosen is None else step.tunables.get(chosen.name, chosen.default)


def step_title(step: Step) -> str:
    """Return the name of a step in a composite, "Ground"."""
    return step.name.replace("_", " ").capitalize()


def step_label(step: Step, label: str) -> str:
    """Return the composite's label of a parameter of a step: "Ground: cell size (m)", "Look for water".

    A label that has the name of the step already goes without.
    """
    names = {word.rstrip("s") for word in re.findall(r"\w+", label.lower())}
    is_named = step.name.split("_")[-1].rstrip("s") in names
    return label if is_named else f"{step_title(step)}: {lower_first(label)}"


def lower_first(text: str) -> str:
    """Return ``text`` as it goes on after a colon; an acronym keeps its capitals."""
    return text[:1].lower() + text[1:] if text[1:2].islower() else text


def as_text(text: str) -> str:
    """Return a help for the command line: no HTML, and no summary and parameters, which QGIS prints itself."""
    sections = re.split(r"\n(?=<h3>)", text)
    kept = "\n".join(section for section in sections if not section.startswith("<h3>Parameters"))
    lines, depth = [], 0
    for line in kept.split("\n")[1:]:
        tag = _LIST.fullmatch(line)
        if tag is None:
            lines.append(line.replace("<h3>", "\n").replace("<li>", "  " * (depth - 1) + "- "))
        else:
            depth += -1 if tag.group(1) else 1
    return html.unescape(re.sub("<[^>]+>", "", "\n".join(lines)))


_LIST = re.compile("<(/?)[ou]l>(?:</li>)?")


def with_picture(text: str, algorithm: str, folder: str) -> str:
    """Return a help text with the picture of an algorithm, where it has one, below the summary.

    Parameters
    ----------
    text : str
        HTML, the summary in its first line.
    algorithm : str
        Id of the algorithm.
    folder : str
        URL of the folder with the pictures.
    """
    if algorithm not in captions():
        return text
    caption = html.escape(captions()[algorithm])
    # Width (pixels) of the help pane of a dialog as it opens; pages set their own.
    picture = f'<p><img src="{folder}/{algorithm}.png" width="220" alt="{caption}"></p>\n<p><i>{caption}</i></p>'
    summary, rest = text.split("\n", 1)
    return f"{summary}\n{picture}\n{rest}"


def page(title: str, text: str) -> str:
    """Return a complete page around the help text of an algorithm."""
    return (
        '<!DOCTYPE html>\n<html lang="en">\n<head>\n<meta charset="utf-8">\n'
        f"<title>{html.escape(title)}</title>\n"
        "<style>body{font-family:sans-serif;max-width:48em;margin:2em auto;line-height:1.5;padding:0 1em}"
        "img{width:100%;max-width:40em}</style>\n"
        f"</head>\n<body>\n<h1>{html.escape(title)}</h1>\n{text}\n</body>\n</html>\n"
    )


_NOT_GIVEN = object()


def tunable_help(tunable: Tunable, default: object = _NOT_GIVEN) -> str:
    """Return one tunable's name, meaning, range and default as HTML."""
    param = tunable.param
    facts = [tunable.range] if tunable.range else []
    facts.append(f"default {_default_text(tunable, tunable.default if default is _NOT_GIVEN else default)}")
    automatic = f" {inline(param.unset_text)}" if tunable.is_optional else ""
    return (
        f"<b>{html.escape(tunable.title)}</b>: {inline(param.help)}{automatic} <i>({html.escape('; '.join(facts))})</i>"
    )


def _default_text(tunable: Tunable, default: object) -> str:
    if default is None:
        return tunable.param.unset
    if isinstance(default, bool):
        return "yes" if default else "no"
    if isinstance(default, tuple):
        return ", ".join(default) or "none"
    return tunable.param.written(default) if isinstance(default, (int, float)) else str(default) or "empty"


def outputs(stage: Stage) -> list:
    """Describe the outputs of a stage, one HTML text each."""
    texts = [_result_text(stage, name, name.upper()) for name in stage.outputs]
    used = [f"{t.name.upper()}_USED" for t in stage.tunables.values() if t.is_optional and t.type in (int, float)]
    if used:
        texts.append(f"<b>{', '.join(used)}</b>: the value that was used, given or automatic.")
    return texts


def _cloud_text(stage: Stage) -> str:
    always = [name for name in stage.writes if name not in stage.written_if]
    written = f" with {_with_conditions(always, stage.written_if)}" if stage.writes else ""
    chosen = _chosen(stage)
    if chosen is not None:
        meanings = [_meaning(name) for name in stage.writes]
        return f"the cloud as it was, and what '{chosen.label}' names of these dimensions:\n{listed(meanings)}"
    if stage.creates:
        return f"a new cloud with {_disk_names(stage.creates)}."
    if stage.merges:
        return f"the points of all clouds in one{written}; withheld points are left out."
    if stage.selects:
        return f"a cloud of the points selected{written}; everything else of them stays, withheld points are left out."
    return f"the cloud{written}; everything else in it stays as it was."


def _with_conditions(always: Iterable[str], written_if: dict[str, str]) -> str:
    """Return dimensions by their names in files: those always written, then others with when they are."""
    groups: dict[str, list[str]] = {"": list(always)}
    for name, when in written_if.items():
        groups.setdefault(when, []).append(name)
    texts = ((_disk_names(names), html.escape(when, quote=False)) for when, names in groups.items() if names)
    return "; ".join(f"{disk} {when}".strip() for disk, when in texts)


def _chosen(stage: Stage) -> Optional[Tunable]:
    """Return the tunable that says which of its dimensions a stage writes; None if it always writes all."""
    tunables = (tunable for tunable in stage.tunables.values() if tunable.type is tuple)
    return next((tunable for tunable in tunables if tunable.param.choices == stage.writes), None)


def _meaning(name: str) -> str:
    dimension = DIMENSIONS[name]
    text = html.escape(with_unit(dimension.description, dimension.unit))
    return f"<i>{name}</i>: {', '.join(dimension.disk)}, {text}"


def _result_text(stage: Stage, of: str, name: str) -> str:
    """Describe one output of a stage, under the name that it has for users."""
    declared = stage.outputs[of]
    if isinstance(declared, Layer):
        described = ((with_unit(one.name, one.unit), one.help.rstrip(".")) for one in declared.fields)
        attributes = listed(f"<i>{html.escape(field)}</i>: {html.escape(text)}" for field, text in described)
        made = f"{html.escape(declared.title)}, with the attributes:\n{attributes}"
    elif isinstance(declared, Raster):
        made = f"{html.escape(with_unit(declared.title, declared.unit))}, a raster."
    elif isinstance(declared, TextFile):
        formats = "; ".join(f"{called} ({', '.join(endings)})" for called, endings in declared.formats.items())
        made = f"{html.escape(declared.title)}, a file: {html.escape(formats)}."
    elif declared == CLOUD:
        made = _cloud_text(stage)
    else:
        measures = ", ".join(with_unit(measure.title, measure.unit) for measure in stage.measures)
        made = f"a page with {html.escape(measures)}; each is an output of its own too."
    return f"<b>{name}</b>: {made}"


def _dimensions(stage: Stage) -> str:
    own = [name for name in stage.reads if not name.startswith(REFERENCE_PREFIX)]
    if_there = [name for name in stage.optional if not name.startswith(REFERENCE_PREFIX)]
    both = (*stage.reads, *stage.optional)
    compared = [name[len(REFERENCE_PREFIX) :] for name in both if name.startswith(REFERENCE_PREFIX)]
    rows = []
    if own:
        optional = f"; if there, {_disk_names(if_there)}" if if_there else ""
        rows.append(f"<b>{'INPUTS' if stage.merges else 'INPUT'}</b>: reads {_disk_names(own)}{optional}.")
    if compared:
        rows.append(f"<b>REFERENCE</b>: reads {_disk_names(compared)}. {inline(stage.reference)}")
    return _list("Inputs", rows + [input_layer_text(input_layer) for input_layer in stage.input_layers])


def input_layer_text(input_layer: InputLayer) -> str:
    """Describe a vector layer that is read, as HTML."""
    needed = "; may be left empty" if input_layer.optional else ""
    name, title = input_layer.name.upper(), html.escape(input_layer.title)
    kind = f"a file ({', '.join(input_layer.endings)})" if input_layer.read else f"a layer of {input_layer.objects}"
    return f"<b>{name}</b>: {title}, {kind}{needed}. {inline(input_layer.help)}"


def _disk_names(names) -> str:
    disk = {VALUES: ("the dimension named",), **{name: DIMENSIONS[name].disk for name in names if name != VALUES}}
    return ", ".join(dict.fromkeys(shown for name in names for shown in disk[name]))


def _list(title: str, rows: list, ordered: bool = False) -> str:
    if not rows:
        return ""
    return f"<h3>{html.escape(title)}</h3>\n{listed(rows, 'ol' if ordered else 'ul')}"


def listed(rows: Iterable[str], tag: str = "ul") -> str:
    """Return rows as a list, HTML."""
    return f"<{tag}>\n" + "\n".join(f"<li>{row}</li>" for row in rows) + f"\n</{tag}>"


def _section(title: str, text: str) -> str:
    return f"<h3>{title}</h3>\n{paragraphs(_CITATION.sub('', text))}" if text else ""


# Keys of docs/references.bib, which the documentation resolves.
_CITATION = re.compile(r"\s*\[[a-z]+\d{4}\]")


def paragraphs(text: str) -> str:
    """Return reStructuredText as docstrings use it (paragraphs, lists, ``code``, *emphasis*) as HTML."""
    blocks = [block for block in re.split(r"\n\s*\n", text.strip()) if block.strip()]
    return "\n".join(_items(block) or f"<p>{inline(block)}</p>" for block in blocks)


_ITEM = re.compile(r"^\s*(?:[*-]|\.\. \[\w+\]|(\d+)\.)\s+", re.MULTILINE)


def _items(block: str) -> Optional[str]:
    """Return a block as a list, None when it is no list."""
    first = _ITEM.match(block)
    if first is None:
        return None
    items = (inline(item) for item in _ITEM.sub("\0", block).split("\0") if item.strip())
    return listed(items, "ol" if first.group(1) else "ul")


def inline(text: str) -> str:
    """Return one paragraph's text as HTML."""
    text = html.escape(" ".join(text.split()), quote=False)
    text = re.sub(r":\w+:`~?\.*([\w.]+)`", r"<code>\1</code>", text)
    text = re.sub(r"``(.+?)``", r"<code>\1</code>", text)
    return re.sub(r"(?<![\w*])\*(\S(?:.*?\S)?)\*(?![\w*])", r"<i>\1</i>", text)
