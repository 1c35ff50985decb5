"""All classes against a reference: merging, what is ignored, outputs and the page."""

import re
import xml.etree.ElementTree as ET

import numpy as np
import pytest

from lidar_buildings.algorithms.quality.assess_classes import assess_classes, merged, parse_groups

TRUE = np.array([2, 2, 2, 2, 5, 5, 3, 6, 6, 9, 14, 7, 1, 64])
CALLED = np.array([2, 2, 2, 3, 5, 4, 3, 6, 2, 2, 15, 18, 0, 2])


def assessed(called=CALLED, **tunables):
    xyz = np.column_stack([np.arange(len(TRUE)), np.zeros((len(TRUE), 2))]).astype(float)
    return assess_classes(xyz, called, xyz, TRUE, **tunables)


def test_figures_by_hand():
    """Of 13 points, without the artefact, three are wrong: ground called plant, a roof and water called ground."""
    values = assessed().values
    assert values["points"] == 13
    assert values["accuracy"] == pytest.approx(100 * 10 / 13)
    assert values["ground_f"] == pytest.approx(100 * 6 / 9)
    assert values["vegetation_f"] == pytest.approx(100 * 6 / 7)
    assert values["building_iou"] == pytest.approx(50)
    assert values["water_f"] == 0
    assert values["wires_f"] == values["noise_f"] == 100
    assert np.isnan(values["bridges_f"])
    assert values["mean_iou"] == pytest.approx(np.mean([50, 75, 50, 0, 100, 100, 100]))


def test_a_class_counts_alone_where_none_is_merged():
    """Then a medium plant that is high, a mast that is a wire, and high noise that is low are wrong, too."""
    values = assessed(merged_classes="").values
    assert values["accuracy"] == pytest.approx(100 * 6 / 13)
    assert values["vegetation_f"] == pytest.approx(100 * 6 / 7)


def test_ignored_classes_do_not_count():
    assert assessed(ignored_classes="").values["points"] == 14
    assert assessed(ignored_classes="0, 1, 64-67").values["points"] == 12


def test_a_perfect_answer_is_perfect():
    values = assessed(TRUE).values
    assert [values[name] for name in ("accuracy", "kappa", "mean_iou")] == pytest.approx([100, 100, 100])


def test_groups_are_read_and_a_class_is_in_one():
    assert [group.tolist() for group in parse_groups("3-5; 7, 18;")] == [[3, 4, 5], [7, 18]]
    assert [part.tolist() for part in merged(np.array([2, 4, 5, 18]), parse_groups("3-5; 7, 18"))] == [
        [2],
        [4, 5],
        [18],
    ]
    with pytest.raises(ValueError, match=r"must have each class in one group, got 5 in two; leave it out of one\."):
        parse_groups("3-5; 5, 6")
    with pytest.raises(ValueError, match=r"Merged classes must be numbers from 0 to 255"):
        parse_groups("3-5; x")


def test_page_shows_matrix_classes_and_map():
    page = assessed().html
    svg = ET.fromstring(re.search(r"<svg.*?</svg>", page, re.DOTALL).group())
    texts = [text.text for text in svg.iter("{http://www.w3.org/2000/svg}text")]
    assert "3, 4, 5 vegetation" in texts
    assert texts.count("75.0 %") == 1  # three of four ground points
    assert "10 of 13 points have the class of the reference" in page
    assert "Map of the result" in page
    assert '<td class="number">66.7 %</td>' in page
