"""What the status bar says."""

import re
from dataclasses import replace

import numpy as np
import pytest
from documents import altered

from app.document import RUBBERY, DistortionRange
from app.document.keyframe import Target
from app.document.queries.clips import clip_of
from app.editor.actions import editing, playback
from app.editor.actions.posing.pose_drag import set_targets
from app.errors import LissomError
from app.motion import InbetweenCache
from app.motion.inbetweens.secondary_correction import SecondaryCorrection
from app.reports.curves import TIMES, measure_curves
from app.ui.bars.status import describe_pose_limit, list_status_items
from engine.maps import distortion


def facts(window):
    return [fact.text for fact in list_status_items(window.session)]


def test_frame_rate_appears_during_playback(window, loose):
    """Else nothing is drawn, and their number says nothing of the machine."""
    del loose
    assert not any("fps" in fact for fact in facts(window))
    playback.toggle_play(window.session)
    window.frames(3)
    assert re.fullmatch(r"\d+ fps", facts(window)[-1])
    playback.toggle_play(window.session)


def test_without_a_project_there_is_nothing_to_tell(window):
    assert facts(window) == []


def test_a_pose_shows_its_distortion_the_handles_and_the_solver(window, loose):
    window.session.diagnostics.solver_seconds = (
        0.0064  # the clock of the tests stands still in a job
    )
    shown, handles, solver = facts(window)
    proven = loose.document.layers[0].keys[1].pose.certificate
    uses = DistortionRange(proven.k, proven.sigma_a, proven.sigma_b).uses(
        loose.document.layers[0].bounds
    )
    most = max(uses, key=lambda use: use.share)
    word = {"k": "Shear", "σa": "Stretch", "σb": "Squeeze"}[most.name]
    assert shown == f"{word} {most.value:.2f}, limit {most.limit:.2f}"
    assert most.share > 0.01
    assert handles == "2 handles"
    assert solver == "pose 6 ms"


@pytest.mark.usefixtures("everything")
def test_inbetweens_show_what_was_measured(window, loose):
    playback.seek(window.session, 12)
    window.settle()
    window.frames(2)
    shown, *_ = facts(window)
    halfway = loose.layer_runtime.store.prepared(loose.clip)[0].frame(0.5)
    fz, fzbar = halfway.fz, halfway.fzbar
    values = {
        "Shear": distortion.k(fz, fzbar).max(),
        "Stretch": distortion.sigma_a(fz, fzbar).max(),
        "Squeeze": distortion.sigma_b(fz, fzbar).min(),
    }
    name, value = shown.split(",")[0].split()
    assert float(value) == pytest.approx(values[name], abs=0.011)


@pytest.mark.usefixtures("loose")
def test_a_bound_that_is_reached_warns(window):
    set_targets(window.session, {1: Target(position=complex(9000, 0))})
    window.settle()
    fact = list_status_items(window.session)[0]
    assert fact.is_warning
    assert not list_status_items(window.session)[1].is_warning


def test_held_back_pull_appears_with_its_remedy(window, loose):
    assert describe_pose_limit(window.session) == ""
    width, height = loose.document.canvas
    set_targets(window.session, {1: Target(position=complex(2.4 * width, 0.5 * height))})
    window.settle()
    layer = loose.layer
    lag = layer.target_errors(layer.key(24).pose)[1]
    message = describe_pose_limit(window.session)
    assert re.fullmatch(
        r"Stretch limit reached – handle \d is \d+ px short(, 1 more too)?", message
    ), message
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
