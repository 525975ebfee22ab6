from dataclasses import replace

import numpy as np
from documents import CENTRE, disc_document
from shapes import regular_polygon

from app.document import clip_of
from app.document.commands import key_commands
from app.motion import IntervalStore, PosableMesh, show
from engine.domain import Domain
from engine.domain.meshing import triangulate


def test_the_nearer_key_stands_in_until_the_in_between_is_prepared():
    """As for a layer that is duplicated there, which was never shown before."""
    document = disc_document()
    figure = document.figures[0]
    first = figure.keys[0].pose
    turned = replace(first, phi=CENTRE + (first.phi - CENTRE) * np.exp(0.8j))
    clip = clip_of(key_commands.insert_key(figure.id, 24, turned)(document), figure.id)
    store = IntervalStore(mesh=PosableMesh.coarse(figure.domain))
    for frame, pose in ((6, first), (18, turned)):
        shown = show(clip, frame, None, [store], None)
        assert shown.stand_in is pose
        assert not shown.is_current
        assert shown.pose is None
        np.testing.assert_array_equal(shown.positions, store.mesh.posed(pose))
        assert show(clip, frame, None, [store], shown) is shown


def test_one_exact_in_between_stands_in_for_others_nearby():
    document = disc_document()
    figure = document.figures[0]
    first = figure.keys[0].pose
    pair = clip_of(key_commands.insert_key(figure.id, 24, first)(document), figure.id)
    store = IntervalStore(mesh=PosableMesh.coarse(figure.domain))
    store.take(store.preparing(pair, [0])())
    bent = replace(first, phi=CENTRE + (first.phi - CENTRE) * np.exp(0.8j))
    clip = clip_of(key_commands.insert_key(figure.id, 24, bent)(document), figure.id)
    assert store.making_frame(pair, 12) is None
    assert store.making_frame(clip, 24) is None
    store.take(store.making_frame(clip, 12)())
    seen = store.interval(clip, 0).one
    exact = IntervalStore(mesh=store.mesh)
    exact.take(exact.preparing(clip, [0])())
    for frame, stand_in in ((12, None), (13, seen), (8, seen), (4, first), (22, bent)):
        shown = show(clip, frame, None, [store], None)
        assert shown.stand_in is stand_in
        if shown.is_current:
            expected = exact.positions(clip, frame)
            np.testing.assert_allclose(shown.positions, expected, atol=1e-5)
    # Of other keys it shows nothing.
    other = clip_of(key_commands.insert_key(figure.id, 24, turned_back(bent))(document), figure.id)
    assert show(other, 12, None, [store], None).stand_in is first


def turned_back(pose):
    return replace(pose, phi=CENTRE + (pose.phi - CENTRE) * np.exp(-0.4j))


def test_figures_that_are_drawn_together_share_the_coarse_triangles():
    outline = 100 * regular_polygon(30)
    mesh = triangulate(outline, 20_000)
    domain = Domain(outline=outline, cage=1.2 * outline, mesh=mesh)
    alone, one_of_two, one_of_ten = (
        len(PosableMesh.coarse(domain, among=among).domain.mesh.triangles) for among in (1, 2, 10)
    )
    assert abs(alone - 12_000) < 600
    assert abs(one_of_two - 6_000) < 300
    assert abs(one_of_ten - 4_000) < 200
