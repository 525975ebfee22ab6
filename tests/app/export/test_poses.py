import numpy as np
import pytest
from animations import BLOB, moving_document, still_document
from documents import altered
from numpy.testing import assert_array_equal

from app.document.queries.clips import clip_of
from app.document.settings import FrameRange
from app.errors import CANCELLED, LissomError
from app.export.frame_renderer import FrameRenderer
from app.export.frame_vertices import CachedVertices
from app.export.plan import ExportRequest, plan_export
from app.motion.extents.extent import bounding_box
from app.motion.inbetweens.animation import Animation
from app.storage import Cancellation


class Counted:
    """Poses that note when they are worked out."""

    def __init__(self, poses) -> None:
        self._poses = poses
        self.asked: list[float] = []

    def positions(self, frame: float):
        self.asked.append(frame)
        return self._poses.positions(frame)


@pytest.mark.parametrize("is_thinned", [False, True])
def test_a_fitted_export_works_every_frame_out_once(gl, tmp_path, monkeypatch, is_thinned):
    monkeypatch.setattr("app.export.frame_renderer._pays", lambda *_: is_thinned)
    document = moving_document()
    (layer,) = document.layers
    animation = Animation(clip_of(document, layer.id))
    counted = Counted(animation)
    poses = {layer.id: CachedVertices(counted)}
    request = ExportRequest(out=tmp_path, settings=document.export, project="walk")
    assert request.settings.framing == "fit"
    plan = plan_export(document, request, poses)
    painter = FrameRenderer(gl, document, {layer.id: BLOB}, poses, plan)
    posed = [painter.pose(time) for time in plan.times]
    assert counted.asked == list(plan.times)
    # What is kept is as fine as what is uploaded.
    direct = [animation.positions(time) for time in plan.times]
    for frame, positions in zip(posed, direct, strict=True):
        assert_array_equal(frame.vertices[0].positions, positions.astype(np.complex64))
    painter.release()


def test_an_extent_that_is_known_is_not_measured_again(tmp_path):
    document = altered(still_document(), frames=FrameRange(0, 10))
    (layer,) = document.layers
    counted = Counted(Animation(clip_of(document, layer.id)))
    poses = {layer.id: CachedVertices(counted)}
    request = ExportRequest(out=tmp_path, settings=document.export, project="walk")
    box = bounding_box(layer.domain.mesh.vertices)
    known = plan_export(document, request, poses, box)
    assert counted.asked == []
    assert plan_export(document, request, poses).view == known.view


def test_what_is_kept_has_its_budget():
    document = still_document()
    (layer,) = document.layers
    size = 8 * len(layer.domain.mesh.vertices)
    counted = Counted(Animation(clip_of(document, layer.id)))
    poses = CachedVertices(counted, budget=2 * size)
    for _ in range(2):
        for frame in range(4):
            poses.cache_positions(frame)
    assert counted.asked == [0, 1, 2, 3, 2, 3]
    counted.asked.clear()
    for frame in range(4):
        poses.positions(frame)
    assert counted.asked == [2, 3]
    poses.positions(0)
    assert counted.asked == [2, 3, 0]


def test_once_it_was_cancelled_an_export_works_out_no_more_poses(tmp_path):
    """What is left behind ends with the frame it is at, though it was to measure all of them."""
    document, cancellation = moving_document(), Cancellation()
    (layer,) = document.layers
    animation = Animation(clip_of(document, layer.id))

    class Cancelled(Counted):
        def positions(self, frame: float):
            if frame == 2:
                cancellation.cancel()
            return super().positions(frame)

    counted = Cancelled(animation)
    request = ExportRequest(out=tmp_path, settings=document.export, project="walk")
    with pytest.raises(LissomError, match=CANCELLED):
        plan_export(document, request, {layer.id: CachedVertices(counted, cancellation)})
    assert counted.asked == [0, 1, 2]
