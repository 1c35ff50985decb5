"""The part of pages that describes the run that made them."""

from lidar_buildings.algorithms.report.page import Row, StepFacts, build_page, with_run


def test_a_page_names_its_cloud_and_parameters():
    page = build_page("Title", "Lead.", {"Table": [Row("a", "1", "")]}, "<p>picture</p>")
    steps = [StepFacts("Ground", 1.25, [Row("Cell <size>", "2 m", "automatic")], ["Found 3"]), StepFacts("Roofs", 2.0)]
    full = with_run(page, [Row("Input", "tile.laz", "")], steps, "In all.")
    order = ["Lead.", "tile.laz", "Table", "picture", "1.2 s", "Found 3.", "3.2 s", "In all.", "Cell &lt;size&gt;"]
    assert [full.index(text) for text in order] == sorted(full.index(text) for text in order)
    # A step without parameters has no table of them.
    assert full.count("<h3>") == 1


def test_a_page_is_completed_once():
    page = with_run(build_page("Title", "Lead.", {}, ""), [Row("Input", "first", "")], [StepFacts("Last")])
    assert with_run(page, [Row("Input", "again", "")], [StepFacts("Again")]) == page
