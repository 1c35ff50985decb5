"""Each reason has a sentence that says what was decided."""

from lidar_buildings.algorithms.cloud.reasons import Reason


def test_every_reason_has_a_sentence_of_its_own():
    texts = [reason.text for reason in Reason]
    assert len(set(texts)) == len(texts)
    assert all(text[0].isupper() and text.endswith(".") for text in texts)


def test_sentences_begin_with_what_was_decided():
    for reason in Reason:
        assert reason.is_building == reason.text.startswith("Building: ")


def test_numbers_fit_the_dimension_and_zero_is_none():
    assert Reason(0) == Reason.NOT_LOOKED_AT
    assert max(Reason) <= 255
