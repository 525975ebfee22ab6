import numpy as np
import pytest
from hypothesis import given, strategies as st
from numpy.testing import assert_allclose

from app.document.channels.easing import HOLD, LINEAR, PRESETS, Easing
from app.errors import LissomError

units = st.floats(0, 1)
curves = st.tuples(units, units, units, units)


@given(curves.map(Easing), units, units)
def test_every_curve_is_monotone_within_0_and_1(easing, s, t):
    s, t = sorted([s, t])
    assert 0 <= easing(s) <= easing(t) <= 1


@pytest.mark.parametrize("curve", [(1, 0, 0, 1), (0, 1, 1, 0), (1, 1, 0, 0), (0.5, 1, 0.5, 0)])
def test_the_steepest_curves_are_monotone(curve):
    weights = [Easing(curve)(s) for s in np.linspace(0, 1, 1001)]
    assert np.diff(weights).min() >= 0


@given(curves, units)
def test_the_weight_lies_on_the_curve(curve, u):
    x1, y1, x2, y2 = curve
    x, y = (3 * u * (1 - u) * ((1 - u) * p + u * q) + u**3 for p, q in ((x1, x2), (y1, y2)))
    s = Easing(curve)(x)
    # Where the curve is steep, rounding of x is what decides.
    before, after = Easing(curve)(max(0.0, x - 1e-9)), Easing(curve)(min(1.0, x + 1e-9))
    assert before - 1e-9 <= s <= after + 1e-9
    assert before - 1e-9 <= y <= after + 1e-9


@given(curves.map(Easing), units)
def test_ends_are_exact_and_linear_is_exact(easing, s):
    assert (easing(0.0), easing(1.0)) == (0.0, 1.0)
    assert LINEAR(s) == s


def test_presets_have_their_known_values():
    assert_allclose(PRESETS["in"](0.5), 0.31535681257253, rtol=0, atol=1e-12)
    assert_allclose(PRESETS["out"](0.5), 0.68464318742747, rtol=0, atol=1e-12)
    assert_allclose(PRESETS["in-out"](0.5), 0.5, rtol=0, atol=1e-12)
    assert [HOLD(s) for s in (0.0, 0.5, 0.999, 1.0)] == [0.0, 0.0, 0.0, 1.0]


@given(st.tuples(units, units, st.just(0.7), st.just(0.7)), st.floats(0.01, 0.99))
def test_a_reversed_easing_runs_backwards(curve, s):
    easing = Easing(curve)
    assert_allclose(easing.reversed()(s), 1 - easing(1 - s), rtol=0, atol=1e-6)
    assert HOLD.reversed() is HOLD


@given(st.one_of(curves.map(Easing), st.sampled_from(list(PRESETS.values()))))
def test_what_is_written_is_read_back(easing):
    assert Easing.parse(easing.to_json()) == easing


def test_names():
    assert [PRESETS[name].name for name in PRESETS] == list(PRESETS)
    assert Easing((0.1, 0.2, 0.3, 0.4)).name == "custom"
    assert Easing.parse([0, 0, 1, 1]) is not None
    assert Easing.parse([0, 0, 1, 1]).to_json() == "linear"


@pytest.mark.parametrize(
    "value",
    [
        "bounce",
        "custom",
        None,
        0.5,
        [0, 0, 1],
        [0, 0, 1, 1, 1],
        [0, 0, 1, 1.5],
        [-0.1, 0, 1, 1],
        [0, 0, 1, float("nan")],
        [0, 0, 1, 10**400],
        [0, 0, 1, True],
        [0, 0, 1, "1"],
        {"a": 1},
    ],
)
def test_other_easings_are_refused(value):
    with pytest.raises(LissomError, match="easing"):
        Easing.parse(value)
