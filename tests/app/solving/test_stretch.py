"""What the three words for stretch do to drawings: measured, as a hand would try them."""

import numpy as np
import pytest
from PIL import Image, ImageDraw

from app.cut_out import build_picture_domain
from app.document import LIMIT_PRESETS, NATURAL, RUBBERY, STIFF, find_limit_preset, relax_limits
from engine.deform import Deformer, Handles
from engine.maps import Boundary, Bounds

SKIN = (230, 180, 150, 255)


def drawn(width, height, *shapes):
    """A picture of filled shapes; each is the name of a drawing function and its arguments."""
    picture = Image.new("RGBA", (width, height), (0, 0, 0, 0))
    draw = ImageDraw.Draw(picture)
    for name, *arguments in shapes:
        getattr(draw, name)(*arguments, fill=SKIN)
    return build_picture_domain(np.asarray(picture), triangles=1500, detail="coarse")[0]


@pytest.fixture(scope="module")
def head():
    """A head with ears and a neck, 440 pixels wide."""
    return drawn(
        500,
        500,
        ("ellipse", (60, 60, 440, 440)),
        ("ellipse", (30, 200, 100, 300)),
        ("ellipse", (400, 200, 470, 300)),
        ("rectangle", (200, 420, 300, 500)),
    )


def pulled(domain, places, targets, bounds):
    """Return the map that brings handles to their targets as far as bounds let it, and the lags."""
    boundary = Boundary.sample(domain)
    handles = Handles.place(boundary, np.array(places, dtype=complex), [1.0] * len(places))
    deformer = Deformer(boundary=boundary, handles=handles, bounds=bounds)
    wanted = handles.targets(np.array(targets, dtype=complex), [np.nan] * len(targets))
    state, _ = deformer.settle(deformer.start(), wanted, at_most=400)
    assert state.certificate.is_certified
    return state.map, np.abs(state.map(np.array(places, dtype=complex)) - np.array(targets))


def test_a_head_stays_a_head(head):
    """Three handles hold it, and one in its middle is pulled by 140 pixels."""
    places = [130 + 250j, 370 + 250j, 250 + 120j, 250 + 250j]
    targets = [*places[:3], 390 + 250j]
    sizes, lags = {}, {}
    for stretch in LIMIT_PRESETS:
        harmonic, lag = pulled(head, places, targets, stretch.bounds)
        moved = np.abs(harmonic(head.mesh.vertices) - head.mesh.vertices)
        sizes[stretch.name], lags[stretch.name] = float(moved.mean()), float(lag[3])
    # Rubbery, the whole head follows by more than the pull itself.
    assert sizes["Rubbery"] > 120
    assert sizes["Natural"] < 0.6 * sizes["Rubbery"]
    assert sizes["Stiff"] < sizes["Natural"]
    assert lags["Stiff"] > lags["Natural"] > lags["Rubbery"]
    assert lags["Natural"] > 40, "the pull is held back"


@pytest.mark.parametrize(("width", "stretch"), [(60, STIFF), (140, NATURAL)])
def test_limbs_bend_by_a_right_angle(width, stretch):
    low, high = 250 - width / 2, 250 + width / 2
    limb = drawn(500, 500, ("rectangle", (40, low, 460, high)))
    places = [60 + 250j, 250 + 250j, 440 + 250j]
    targets = [*places[:2], 250 + 440j]
    _, lags = pulled(limb, places, targets, stretch.bounds)
    assert lags.max() < 1.5


def test_words_for_bounds():
    assert [find_limit_preset(stretch.bounds).name for stretch in LIMIT_PRESETS] == [
        "Stiff",
        "Natural",
        "Rubbery",
    ]
    assert find_limit_preset(Bounds(k=0.5, sigma_a=2.0, sigma_b=0.4)) is None
    for tighter, looser in ((STIFF, NATURAL), (NATURAL, RUBBERY)):
        b = tighter.bounds
        assert looser.bounds.allow(k=b.k, sigma_a=b.sigma_a, sigma_b=b.sigma_b)
        assert relax_limits(b) == looser.bounds
    assert relax_limits(RUBBERY.bounds) is None
    # What was allowed stays so.
    assert relax_limits(Bounds(k=0.7, sigma_a=1.5, sigma_b=0.6)) == Bounds(
        k=0.7, sigma_a=2.0, sigma_b=0.5
    )
