import pytest
from animations import BLOB, evaluator_of, moving_document, still_document
from documents import altered
from numpy.testing import assert_allclose

from app.document.queries.clips import clip_of
from app.document.settings import FrameRange
from app.errors import CANCELLED, LissomError
from app.export.frame_renderer import FrameRenderer
from app.export.plan import plan_export
from app.export.request import ExportRequest
from app.motion import Evaluator, LayerStages
from app.motion.extents.extent import bounding_box
from app.motion.inbetweens.animation import Animation
from app.storage import Cancellation


class Counted(LayerStages):
    """Stages that note which frames are computed."""

    def __init__(self, document) -> None:
        own = LayerStages.exact(clip_of(document, document.layers[0].id))
        super().__init__(layer_id=own.layer_id, store=own.store, corrected=own.corrected)
        self.asked: list[float] = []

    def frame(self, document, frame, carried):
        self.asked.append(frame)
        return super().frame(document, frame, carried)


@pytest.mark.parametrize("is_thinned", [False, True])
def test_a_fitted_export_works_every_frame_out_once(gl, tmp_path, monkeypatch, is_thinned):
    monkeypatch.setattr("app.export.frame_renderer._pays", lambda *_: is_thinned)
    document = moving_document()
    (layer,) = document.layers
    counted = Counted(document)
    evaluator = evaluator_of(counted)
    request = ExportRequest(out=tmp_path, settings=document.export, project="walk")
    assert request.settings.framing == "fit"
    plan = plan_export(document, request, evaluator)
    painter = FrameRenderer(gl, document, {layer.id: BLOB}, evaluator, plan)
    posed = [painter.pose(time) for time in plan.times]
    assert counted.asked == list(plan.times)
    direct = Animation(clip_of(document, layer.id))
    for frame in posed:
        assert_allclose(
            frame.vertices[layer.id].positions,
            direct.positions(frame.scene.frame),
            rtol=0,
            atol=1e-9,
        )
    painter.release()


def test_an_extent_that_is_known_is_not_measured_again(tmp_path):
    document = altered(still_document(), frames=FrameRange(0, 10))
    counted = Counted(document)
    request = ExportRequest(out=tmp_path, settings=document.export, project="walk")
    box = bounding_box(document.layers[0].domain.mesh.vertices)
    known = plan_export(document, request, evaluator_of(counted), box)
    assert counted.asked == []
    assert plan_export(document, request, evaluator_of(counted)).view == known.view


def test_what_is_kept_has_its_budget(monkeypatch):
    document = still_document()
    size = 16 * len(document.layers[0].domain.mesh.vertices)
    monkeypatch.setattr("app.motion.evaluator.FRAMES_BUDGET", 2 * size)
    counted = Counted(document)
    evaluator = evaluator_of(counted)
    for _ in range(2):
        for frame in range(4):
            evaluator.evaluate(document, frame, keep=True)
    assert counted.asked == [0, 1, 2, 3, 2, 3]
    counted.asked.clear()
    for frame in range(4):
        evaluator.evaluate(document, frame)
    assert counted.asked == [2, 3]
    evaluator.evaluate(document, 0)
    assert counted.asked == [2, 3, 0]


def test_once_it_was_cancelled_an_export_works_out_no_more_poses(tmp_path):
    """What is left behind ends with the frame it is at, though it was to measure all of them."""
    document, cancellation = moving_document(), Cancellation()

    class Cancelled(Counted):
        def frame(self, document, frame, carried):
            if frame == 2:
                cancellation.cancel()
            return super().frame(document, frame, carried)

    counted = Cancelled(document)
    evaluator = Evaluator(layers={counted.layer_id: counted}, check=cancellation.check)
    request = ExportRequest(out=tmp_path, settings=document.export, project="walk")
    with pytest.raises(LissomError, match=CANCELLED):
        plan_export(document, request, evaluator)
    assert counted.asked == [0, 1, 2]
