from dataclasses import dataclass

import numpy as np
import pytest
from messages import says
from numpy.testing import assert_array_equal
from scipy.sparse import csr_array

from engine.arrays import (
    ABOVE_MOST,
    BELOW_LEAST,
    FEW_ENTRIES,
    NO_WORD,
    NOT_A_NUMBER,
    NOT_ABOVE,
    NOT_COMPLEX,
    NOT_FINITE,
    NOT_REAL,
    NOT_WHOLE,
    TOO_LARGE,
    as_number,
    as_points,
    as_reals,
    freeze,
    nbytes_of,
    readonly,
    require_word,
)
from engine.errors import EngineError


def test_a_frozen_array_is_a_copy_that_nobody_writes_to() -> None:
    values = np.arange(6.0).reshape(2, 3)
    frozen = readonly(values)
    values[0, 0] = 9
    assert_array_equal(frozen, [[0, 1, 2], [3, 4, 5]])
    with pytest.raises(ValueError, match="read-only"):
        frozen[0, 0] = 1
    assert values.flags.writeable


def test_a_view_of_a_writable_array_is_copied() -> None:
    values = np.arange(6.0)
    view = values[:3]
    view.setflags(write=False)
    frozen = readonly(view)
    values[0] = 9
    assert frozen[0] == 0


def test_a_frozen_array_is_not_copied_again() -> None:
    frozen = readonly(np.arange(3.0))
    assert readonly(frozen) is frozen


@pytest.mark.parametrize(
    ("values", "reason"),
    [
        (["a"], says(NOT_COMPLEX)),
        ([[1, 2]], "one-dimensional"),
        ([1, 2], says(FEW_ENTRIES, at_least=3, count=2)),
        ([0, 1, np.nan], says(NOT_FINITE, index=2)),
        ([0, complex(0, np.inf), 1], says(NOT_FINITE, index=1)),
    ],
)
def test_points_that_cannot_be_used_are_refused_in_words(values: list, reason: str) -> None:
    with pytest.raises(EngineError, match=reason):
        as_points(values, "outline", at_least=3)


def test_points_become_complex_and_frozen() -> None:
    points = as_points([1, 2, 3], "points")
    assert points.dtype == np.complex128
    assert not points.flags.writeable


@pytest.mark.parametrize("order", ["C", "F"])
def test_an_array_is_frozen_in_place_and_keeps_its_order_of_memory(order):
    array = np.zeros((3, 4), order=order)
    frozen = freeze(array)
    assert frozen is array
    assert frozen.flags.f_contiguous == (order == "F")
    with pytest.raises(ValueError, match="read-only"):
        array[0] = 1


def test_memory_is_counted_once_and_not_what_others_hold():
    @dataclass
    class Thing:
        own: object
        others: tuple[object, ...] = ()

    whole, other = np.zeros(100), np.zeros(7)
    sparse = csr_array(np.eye(5))
    in_sparse = sparse.data.nbytes + sparse.indices.nbytes + sparse.indptr.nbytes
    thing = Thing(whole, (whole[::2], Thing(other), "name", None, sparse))
    assert nbytes_of(thing) == 800 + 56 + in_sparse
    # A view keeps all of what it looks at.
    assert nbytes_of(whole[:1]) == nbytes_of(whole, thing, but=(other, sparse)) == 800
    assert nbytes_of(thing, but=(thing,)) == nbytes_of() == 0


@pytest.mark.parametrize("value", ["1", None, 1j, np.nan, np.inf, np.ones(2), [1]])
def test_number_is_refused_when_it_is_none(value) -> None:
    with pytest.raises(EngineError, match=says(NOT_A_NUMBER, name="Speed")):
        as_number(value, "Speed", above=0, most=5)


@pytest.mark.parametrize(
    ("value", "message"),
    [
        (-1, says(NOT_ABOVE, above=0.0, value=-1)),
        (0, says(NOT_ABOVE, above=0.0, value=0)),
        (5.5, says(ABOVE_MOST, most=5.0, value=5.5)),
    ],
)
def test_number_is_refused_when_it_is_out_of_range(value, message) -> None:
    with pytest.raises(EngineError, match=message):
        as_number(value, "Speed", above=0, most=5)


@pytest.mark.parametrize("value", [1, 1.0, True, np.float64(1), np.float32(1), np.int32(1)])
def test_number_may_be_of_any_real_type(value) -> None:
    assert as_number(value, "Speed", least=1, most=1) == 1


def test_number_is_refused_when_it_is_too_small_or_not_whole() -> None:
    for value, message in ((2, says(BELOW_LEAST, least=1000)), (1000.5, says(NOT_WHOLE))):
        with pytest.raises(EngineError, match=message):
            as_number(value, "The count", least=1000, most=2000, is_whole=True)


def test_reals_may_be_infinite_but_not_text() -> None:
    assert_array_equal(as_reals([1, np.inf, np.nan], "angles"), [1, np.inf, np.nan])
    for values in (["a"], [1j], [None]):
        with pytest.raises(EngineError, match=says(NOT_REAL, name="angles")):
            as_reals(values, "angles")


def test_points_are_refused_when_they_are_too_far_away() -> None:
    with pytest.raises(EngineError, match=says(TOO_LARGE, most=10.0, index=1)):
        as_points([1, -20, 3], "places", most=10)


def test_word_is_refused_when_it_is_not_known() -> None:
    require_word("keep", ("keep", "fill"), "Holes")
    for word in ("maybe", ["keep"], None):
        with pytest.raises(EngineError, match=says(NO_WORD, words="'keep', 'fill'")):
            require_word(word, ("keep", "fill"), "Holes")
