"""What the status bar says."""

import re
from dataclasses import replace

import numpy as np
import pytest
from documents import altered

from app.document import RUBBERY
from app.document.keyframe import Target
from app.document.queries.clips import clip_of
from app.editor.actions import editing
from app.editor.actions.posing.motion_presets import rigging
from app.editor.actions.posing.pose_drag import set_targets
from app.editor.work.drag_session import DragSession
from app.editor.work.jobs import Jobs
from app.errors import LissomError
from app.motion import InbetweenCache
from app.motion.inbetweens.secondary_correction import SecondaryCorrection
from app.reports.curves import TIMES, measure_curves
from app.ui.bars.status import UPDATES, describe_pose_limit, find_state


def test_status_bar_says_what_waits_for_a_pose_that_still_moves(window, loose, monkeypatch):
    # A quick worker may find the pose before the next frame: here it stays on its way.
    monkeypatch.setattr(DragSession, "is_at_rest", False)
    width, height = loose.document.canvas
    set_targets(window.session, {1: Target(position=complex(2.4 * width, 0.5 * height))})

    def text():
        state = find_state(window.session)
        return "" if state is None else state.text

    window.until(lambda: text().startswith("Still moving"))
    rigging.rig_layer(window.session)
    assert re.fullmatch(r"Still moving · \d+ px to go, then: Rig this", text())
    monkeypatch.undo()
    window.settle()


@pytest.mark.usefixtures("loose")
def test_status_bar_names_no_job_that_only_updates_the_animation(window, monkeypatch):
    assert find_state(window.session) is None
    for kind in UPDATES:
        monkeypatch.setattr(Jobs, "running_for", lambda _jobs, _seconds, kind=kind: (kind,))
        state = find_state(window.session)
        assert (state.text, state.label) == ("Updating the animation…", "Cancel")


def test_held_back_pull_appears_with_its_remedy(window, loose):
    assert describe_pose_limit(window.session) == ""
    width, height = loose.document.canvas
    set_targets(window.session, {1: Target(position=complex(2.4 * width, 0.5 * height))})
    window.settle()
    layer = loose.layer
    lag = layer.target_errors(layer.key(24).pose)[1]
    message = describe_pose_limit(window.session)
    assert re.fullmatch(r"At its limit · handle \d is \d+ px short(, and 1 more)?", message), (
        message
    )
    steps = loose.history.undo_label

    def loosen(robot):
        robot.item_click("**/Loosen")

    window.run(loosen)
    window.settle()
    assert loose.layer.bounds == RUBBERY.bounds
    assert loose.layer.target_errors(loose.layer.key(24).pose)[1] < 0.5 * lag
    assert loose.layer.is_proven(loose.layer.key(24).pose)
    editing.undo(window.session)
    assert loose.layer is layer, "looser limits and the pose within them are one step"
    assert loose.history.undo_label == steps


def test_handle_of_an_earlier_correction_that_was_deleted_is_not_told(window, loose):
    runtime, kept = loose.layer_runtime, loose.layer.handles[0].id
    errors = {kept: 50.0, 99: 80.0}
    earlier = SecondaryCorrection(target_errors=errors, limits=("k",))
    runtime.shown = replace(runtime.shown, correction=earlier, is_approximate=True)
    assert runtime.shown.track_errors == {kept: 50.0}
    assert "50 px short" in describe_pose_limit(window.session)


@pytest.mark.usefixtures("everything")
def test_extremes_between_the_times_that_were_measured(loose):
    curves = measure_curves(loose.clip, loose.layer_runtime.store.prepared(loose.clip))
    assert curves.extremes.shape == (TIMES, 3)
    np.testing.assert_array_equal(curves.extremes_at(0), curves.extremes[0])
    np.testing.assert_allclose(curves.extremes_at(24), curves.extremes[-1], rtol=1e-12, atol=0)
    middle = curves.extremes_at(12)
    low, high = np.sort(curves.extremes[TIMES // 2 - 1 : TIMES // 2 + 1], axis=0)
    assert (low <= middle).all()
    assert (middle <= high).all()
    # In a loop the way back follows the last key, and leads up to the first.
    last = loose.document.layers[0].keys[-1]
    looped = altered(
        loose.document,
        loop=True,
        keys=(replace(loose.document.layers[0].keys[0], frame=10), last),
        frames=replace(loose.document.frames, last=48),
    )
    looped = clip_of(looped, 0)
    store = InbetweenCache(mesh=loose.layer_runtime.store.mesh)
    store.add(store.segments_job(looped, store.missing_segments(looped, 0))())
    again = measure_curves(looped, store.prepared(looped))
    assert again.extremes_at(5) == again.extremes_at(53)
    assert again.extremes_at(5) != again.extremes_at(20)


@pytest.mark.parametrize(
    ("text", "wanted"),
    [
        ("cannot write out: it is a file", "Cannot write out: it is a file."),
        ("cow.png is damaged", "cow.png is damaged."),
        ("There is no key at frame 3.", "There is no key at frame 3."),
    ],
)
def test_error_is_a_sentence(window, text, wanted):
    def fail(_):
        raise LissomError(text)

    window.act(fail)
    (toast,) = window.session.notices.toasts
    assert toast.text == wanted
