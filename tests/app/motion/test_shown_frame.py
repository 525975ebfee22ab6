from dataclasses import replace

import numpy as np
from documents import CENTRE, disc_document
from shapes import regular_polygon

from app.document import clip_of
from app.document.commands import key_commands
from app.motion import Motion, PosableMesh, show
from engine.domain import Domain
from engine.domain.meshing import triangulate


def test_what_was_never_shown_is_shown_roughly_between_two_keys():
    """As a layer is that is duplicated there, before its in-betweens are prepared."""
    document = disc_document()
    figure = document.figures[0]
    first = figure.keys[0].pose
    turned = replace(first, phi=CENTRE + (first.phi - CENTRE) * np.exp(0.8j))
    clip = clip_of(key_commands.insert_key(figure.id, 24, turned)(document), figure.id)
    motion = Motion.at_rest(clip, PosableMesh.coarse(figure.domain))
    shown = show(clip, 12, None, (motion,), None)
    assert not shown.is_current
    rest = figure.domain.mesh.vertices
    halfway = CENTRE + (rest - CENTRE) * np.exp(0.4j)
    np.testing.assert_allclose(shown.positions, halfway, rtol=0, atol=1e-3)
    assert show(clip, 12, None, (motion,), shown) is shown


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
