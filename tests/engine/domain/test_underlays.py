"""Material of a covered limb that continues under the limb in front."""

import numpy as np
import pytest

from engine.domain import build_domain, find_closed_cuts

# Two limbs side by side below a body; the right one is half as wide as the left one.
MASK = np.zeros((300, 240), dtype=np.bool_)
MASK[20:120, 40:200] = True
MASK[120:280, 60:164] = True
LINE = 128 + 1j * np.linspace(5.0, 175.0, 60)  # upwards, the narrow limb on its right


@pytest.fixture(scope="module")
def domain():
    return build_domain(MASK, triangles=3000, detail="normal", cut_lines=[LINE])[0]


def test_covered_limb_continues_under_the_other_up_to_its_visible_width(domain):
    plain = find_closed_cuts(domain)
    seam = find_closed_cuts(domain, [LINE[::-1]])
    rest = domain.mesh.vertices
    count = len(rest)
    places, painted = seam.close_cuts(rest), seam.find_painted(rest)
    assert seam.further_vertices > 5
    # The slits are closed as without an underlay.
    np.testing.assert_array_equal(places[:count], plain.close_cuts(rest))
    further, shown = places[count:], painted[count:]
    assert (further.real < 129).all()
    assert further.real.min() < 115
    assert (further.real > 60).all()
    # Each place shows a place of the narrow limb.
    assert (shown.real > 126).all()
    assert (shown.real < 180).all()
    # It ends at the tip of the slit.
    high = further.imag > 165
    assert np.abs(further[high].real - 128).max(initial=0.0) < 10


def test_trunk_continues_under_a_limb_as_its_mirror_image():
    arm = 70 + 1j * np.linspace(5.0, 140.0, 60)  # of a whole body, without a gap beside the arm
    body = np.zeros((300, 240), dtype=np.bool_)
    body[20:280, 40:200] = True
    domain = build_domain(body, triangles=3000, detail="normal", cut_lines=[arm])[0]
    seam = find_closed_cuts(domain, [arm[::-1]])
    count = len(domain.mesh.vertices)
    used = np.unique(seam.underlay.triangles)
    used = used[used >= count]
    further = seam.close_cuts(domain.mesh.vertices)[used]
    shown = seam.find_painted(domain.mesh.vertices)[used]
    middle = (further.imag > 50) & (further.imag < 90)
    assert 15 < (70 - further[middle].real).max() < 25
    np.testing.assert_allclose(further.real + shown.real, 140, atol=1.5)


def test_a_limb_is_no_trunk_where_its_slit_begins_at_a_gap():
    # Two limbs below a body, the covering one little wider; a knife line leads on from their gap.
    mask = MASK.copy()
    mask[220:280, 122:134] = False
    low, high = 128 + 84j, 128 + 175j
    knife = np.concatenate([[128 + 5j], low + np.linspace(0, 1, 40) * (high - low)])
    domain, _ = build_domain(mask, triangles=3000, detail="normal", cut_lines=[knife])
    # The slit may lie a little beside its line, so that the line is in the narrow limb.
    under = find_closed_cuts(domain, [knife[:0:-1] + 0.5]).underlay
    rest = domain.mesh.vertices
    painted = under.paint(rest)[
        np.unique(under.triangles[under.triangles >= len(rest)]) - len(rest)
    ]
    # Its far outline closes it all along: the places that are shown reach up to it.
    low_down = painted[painted.imag < 110]
    assert low_down.real.max() > 158
    assert np.ptp(low_down[low_down.real > 155].imag) > 15


def test_underlay_follows_an_affine_map_exactly_beyond_the_slit(domain):
    seam = find_closed_cuts(domain, [LINE[::-1]])
    rest = domain.mesh.vertices
    moved = (0.8 + 0.3j) * rest + 0.1 * rest.conj() + 5
    places = seam.close_cuts(rest)
    np.testing.assert_allclose(
        seam.close_cuts(moved), (0.8 + 0.3j) * places + 0.1 * places.conj() + 5, atol=1e-8
    )


def test_underlay_is_painted_before_the_mesh(domain):
    seam = find_closed_cuts(domain, [LINE[::-1]])
    triangles = seam.order_under(domain.mesh.triangles)
    under = len(triangles) - len(domain.mesh.triangles)
    assert under > 0
    np.testing.assert_array_equal(triangles[under:], domain.mesh.triangles)
    assert triangles.max() < len(domain.mesh.vertices) + seam.further_vertices
    values = np.arange(len(domain.mesh.vertices), dtype=np.float32)
    assert len(seam.repeat_values(values)) == len(values) + seam.further_vertices


def test_lines_without_a_covered_side_have_no_underlay(domain):
    assert find_closed_cuts(domain).underlay is None
    far_away = 1000 + LINE
    assert find_closed_cuts(domain, [far_away]).underlay is None
