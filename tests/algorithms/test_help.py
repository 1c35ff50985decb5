"""Help of stages and pipelines as HTML: complete, with pictures, and readable as plain text."""

from __future__ import annotations

from pathlib import Path

from lidar_buildings.algorithms.captions import captions
from lidar_buildings.algorithms.help import (
    as_text,
    inline,
    paragraphs,
    pipeline_help,
    stage_help,
    tunable_help,
    with_picture,
)
from lidar_buildings.algorithms.pipelines import PIPELINES
from lidar_buildings.algorithms.stages import STAGES
from lidar_buildings.tests.toys import TOYS

PICTURES = Path(__file__).resolve().parents[2] / "resources" / "help" / "pictures"


def test_every_picture_has_a_caption_and_belongs_to_an_algorithm():
    ids = {declared.id for declared in (*STAGES.values(), *PIPELINES.values())}
    assert set(captions()) <= ids
    assert {path.stem for path in PICTURES.glob("*.png")} == set(captions())
    assert all(path.read_bytes().startswith(b"\x89PNG") for path in PICTURES.iterdir())


def test_the_picture_is_below_the_summary():
    text = with_picture("<p>Find roofs.</p>\n<p>More.</p>", "segmentroofs", "file:///pictures")
    assert text.index("roofs.</p>") < text.index('<img src="file:///pictures/segmentroofs.png"') < text.index("More.")
    assert with_picture("<p>Nothing to see.</p>", "filterpoints", "pictures") == "<p>Nothing to see.</p>"


def test_help_of_a_stage_has_all_its_parts():
    text = stage_help(TOYS["toy_lift"])
    assert "<p>Lift every point.</p>" in text
    assert "<p>A text in two parts, with <code>code</code> and <i>emphasis</i>.</p>" in text
    assert "reads X, Y, Z, Classification" in text
    assert "<ul>\n<li>One.</li>\n<li>Two.</li>\n</ul>" in text
    assert "<h3>References</h3>\n<p>Nobody (2000), Nothing.</p>" in text


def test_help_of_a_tunable_has_unit_range_default_and_automatic():
    tunables = TOYS["toy_lift"].tunables
    assert tunable_help(tunables["step"]) == (
        "<b>Step (m)</b>: Added to all heights. <i>(greater than 0 m and at most 10 m; default 1.5 m)</i>"
    )
    assert "Automatic: the lowest point. <i>(at least 0 m; default automatic)</i>" in tunable_help(tunables["base"])
    assert "default ground, building" in tunable_help(tunables["only"])
    assert "default no" in tunable_help(tunables["flat"])
    limits = STAGES["filter_points"].tunables
    assert "Empty: no limit; the log gives the range of the cloud." in tunable_help(limits["min_height"])
    assert tunable_help(limits["min_height"]).endswith("default none)</i>")
    assert tunable_help(limits["classes"]).endswith("<i>(default empty)</i>")


def test_dimensions_to_choose_from_are_explained_one_by_one():
    text = stage_help(STAGES["compute_features"])
    assert "<i>(any of linearity, planarity, " in text
    assert (
        "<b>OUTPUT</b>: the cloud as it was, and what 'Features' names of these dimensions:\n<ul>\n"
        "<li><i>linearity</i>: Linearity, (l1 - l2) / l1</li>\n"
    ) in text
    assert "<li><i>normal</i>: NormalX, NormalY, NormalZ, unit normal, upward</li>\n" in text
    assert "<li><i>plan_radius</i>: PlanRadius, reach of the neighbors in plan (m)</li>\n" in text


def test_dimensions_that_may_be_left_out_have_their_condition():
    """Outputs of 'Segment planes (RANSAC)' were promised, and are written only if asked for."""
    assert (
        "<b>OUTPUT</b>: the cloud with SegmentID; NormalX, NormalY, NormalZ with 'Write normals'; everything else"
    ) in stage_help(STAGES["segment_planes_ransac"])
    assert "<b>OUTPUT</b>: the cloud with EarlierClass where classes are kept; everything else" in stage_help(
        STAGES["keep_classes"]
    )
    mapped = pipeline_help(PIPELINES["map_footprints"])
    assert "ClusterID, WallOf; NormalX, NormalY, NormalZ with 'Write normals'.</li>" in mapped
    # One step writes the confidence always, others change it.
    assert "where the cloud has them" not in pipeline_help(PIPELINES["detect_buildings"])


def test_the_command_line_shows_text():
    text = as_text(stage_help(TOYS["toy_lift"]))
    assert text.startswith("A text in two parts, with code and emphasis.\n\nInputs\n- INPUT: reads X, Y, Z")
    assert text.endswith("\n\nNotes\n- One.\n- Two.\n\nReferences\nNobody (2000), Nothing.")
    assert "- FOOTPRINTS: Footprints, with the attributes:\n  - id: Number of the polygon\n" in as_text(
        stage_help(TOYS["toy_outline"])
    )
    # QGIS prints the summary before it, and every parameter with its tooltip after it.
    assert "Lift every point" not in text
    assert "Added to all heights" not in text
    for stage in STAGES.values():
        assert not set("<>") & set(as_text(stage_help(stage)).replace("->", "").replace(" < ", "").replace(" > ", ""))


def test_text_is_escaped():
    assert inline("a < b & ``c > d``") == "a &lt; b &amp; <code>c &gt; d</code>"
    assert inline("2 * 3 * 4") == "2 * 3 * 4"


def test_numbered_lists_are_lists():
    assert paragraphs("1. One\n   goes on\n2. Two") == "<ol>\n<li>One goes on</li>\n<li>Two</li>\n</ol>"
