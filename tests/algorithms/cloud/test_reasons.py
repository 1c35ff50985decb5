"""Each reason has a sentence that says what was decided."""

import numpy as np

from lidar_buildings.algorithms.cloud.reasons import Evidence, Reason, evidence_text, packed_evidence


def test_every_reason_has_a_sentence_of_its_own():
    texts = [reason.text for reason in Reason]
    assert len(set(texts)) == len(texts)
    assert all(text[0].isupper() and text.endswith(".") for text in texts)


def test_every_reason_has_a_short_name_of_its_own():
    labels = [reason.label for reason in Reason]
    assert len(set(labels)) == len(labels)
    assert max(map(len, labels)) <= 20


def test_sentences_begin_with_what_was_decided():
    for reason in Reason:
        assert reason.is_building == reason.text.startswith("Building: ")


def test_numbers_fit_the_dimension_and_zero_is_none():
    assert Reason(0) == Reason.NOT_LOOKED_AT
    assert max(Reason) <= 255


def test_evidence_is_stored_in_one_number_and_read_as_words():
    kinds = np.array([Evidence.POINTS, Evidence.ENTROPY, Evidence.PENETRATION, Evidence.SURROUNDINGS, Evidence.NONE])
    packed = packed_evidence(kinds, np.array([79, 0.7126, 0.38, 0.4499, 1]), np.array([122.4, 0.78, 0.4, 0.4, 1]))
    assert packed.dtype == np.uint32
    assert packed.tolist() == [1_0079_0122, 2_0713_0780, 3_0380_0400, 4_0450_0400, 0]
    assert [evidence_text(one) for one in packed.tolist()] == [
        "79 points of a roof surface (confidence 0.5 at 122)",
        "entropy 0.71 (limit 0.78)",
        "38 % of the beam passes (limit 40 %)",
        "45 % of the points around are on buildings (limit 40 %)",
        "",
    ]


def test_what_is_not_known_or_not_ours_is_no_evidence():
    """Numbers of other programs and values beyond the digits are neither errors nor another kind."""
    unknown = packed_evidence(np.full(2, Evidence.ENTROPY), np.array([np.nan, 0.5]), np.array([0.7, np.nan]))
    assert unknown.tolist() == [0, 0]
    large = packed_evidence(np.array([Evidence.POINTS]), np.array([123_456]), np.array([1e9]))
    assert large.tolist() == [1_9999_9999]
    assert [evidence_text(one) for one in (0, 500_000_000, 2**32 - 1)] == ["", "", ""]
