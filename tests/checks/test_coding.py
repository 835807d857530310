import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays

from timemap_cli.checks.coding import decoded, encoded

WHOLE = st.one_of(st.integers(0, 6000).map(lambda cm: cm / 100), st.just(np.inf), st.just(np.nan))


def test_a_ring_is_written_as_its_first_range_and_a_letter_for_each_step():
    ranges = np.array([2.31, 2.32, 2.34, 2.34, 2.33, 4.12, np.nan, np.nan, np.inf, 2.0])
    assert encoded(ranges) == "231 ab=A 412 ?2 *1 200"


def test_letters_reach_26_centimetres_and_no_farther():
    assert encoded(np.array([1.0, 1.26, 1.0, 1.27])) == "100 zZ 127"


def test_ranges_are_rounded_to_the_centimetre():
    assert encoded(np.array([1.234, 1.236])) == "123 a"


@given(arrays(np.float64, st.integers(1, 400), elements=WHOLE))
def test_what_is_written_is_read_back(ranges):
    assert np.allclose(decoded(encoded(ranges), len(ranges)), ranges, rtol=0, atol=1e-9, equal_nan=True)


@pytest.mark.parametrize(
    ("line", "message"),
    [
        ("231 a", "2 angle bins instead of 3"),
        ("231 a!", "'a!' is no part of a ring"),
        ("a 231 b", "'a' has no range to count from"),
        ("?2 a", "'a' has no range to count from"),
    ],
)
def test_a_damaged_line_is_refused(line, message):
    with pytest.raises(ValueError, match=message):
        decoded(line, 3)
