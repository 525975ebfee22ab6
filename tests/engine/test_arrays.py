from dataclasses import dataclass

import numpy as np
import pytest
from messages import says
from numpy.testing import assert_array_equal
from scipy.sparse import csr_array

from engine.arrays import (
    FEW_ENTRIES,
    NOT_COMPLEX,
    NOT_FINITE,
    as_points,
    freeze,
    held_bytes,
    readonly,
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
    assert held_bytes(thing) == 800 + 56 + in_sparse
    # A view keeps all of what it looks at.
    assert held_bytes(whole[:1]) == held_bytes(whole, thing, but=(other, sparse)) == 800
    assert held_bytes(thing, but=(thing,)) == held_bytes() == 0
