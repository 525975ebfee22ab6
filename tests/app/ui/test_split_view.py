"""Two methods in one viewport: what is seen, dragged, measured, and left out of undo."""

import numpy as np
import pytest
from bars import HALF, LAST, bend_bar
from imgui_bundle import ImVec2

from app.document import Baseline, Target, Variant
from app.editor.actions import playback, viewing
from app.editor.actions.posing.handles import add_handle
from app.editor.actions.posing.pose_drag import set_targets


@pytest.fixture
def between(window):
    """The bar, bent far, half way to its second key."""
    return window.again(stop_half_way)


def stop_half_way(window):
    bent = window.again(bend_bar, LAST, "loose")
    width, _ = bent.document.canvas
    targets = dict(bent.layer_runtime.shown.pose.targets)
    last = max(targets)
    targets[last] = Target(position=complex(0.35 * width, 0.6 * width))
    set_targets(window.session, targets)
    window.settle()
    playback.seek(window.session, HALF)
    window.settle()


def divider(window):
    """Return where the divider is on the screen, and where it begins."""
    found = []

    def look(robot):
        grip = robot.item_info("**/divider").rect_full
        found.append(((grip.min.x + grip.max.x) / 2, grip.min.y))

    window.run(look)
    return found[0]


def press_u(window):
    window.run(lambda robot: robot.key_press(window.Key.u))
    window.settle()


def test_the_shortcut_splits_the_view_and_puts_it_together_again(window, between):
    session = window.session
    depth = between.history.undo_label
    assert session.display.compare_view is None
    alone = window.picture()
    press_u(window)
    assert session.display.compare_view is not None
    assert session.display.compare_view.method is Variant.LINEAR
    comparison = between.layer_runtime.comparison
    own, other = between.layer_runtime.shown.positions, comparison.shown.positions
    # Halfway round, straight ways are shorter than arcs.
    assert np.abs(own - other).max() > 0.01 * np.ptp(own.real)
    assert (np.abs(np.asarray(window.picture()).astype(int) - np.asarray(alone)) > 24).any()
    assert between.history.undo_label == depth
    press_u(window)
    assert session.display.compare_view is None
    assert between.layer_runtime.comparison is None


def test_the_divider_is_dragged_and_the_methods_change_sides_there(window, between):
    session = window.session
    viewing.toggle_comparison(session)
    window.settle()
    before = session.display.compare_view.divider
    x, top = divider(window)

    def drag(robot):
        robot.mouse_move_to_pos(ImVec2(x, top + 60))
        robot.mouse_down()
        robot.mouse_move_to_pos(ImVec2(x - 150, top + 60))
        robot.mouse_up()

    window.run(drag)
    width = session.display.screen[0]
    assert session.display.compare_view.divider == pytest.approx(
        before - 150 / width, abs=3 / width
    )
    assert divider(window)[0] == pytest.approx(x - 150, abs=3)
    assert session.tools.active_tool is None
    assert len(between.layer.handles) == 2


@pytest.mark.parametrize("baseline", [Baseline.ARAP, Baseline.SIG13])
@pytest.mark.usefixtures("everything")
def test_methods_for_comparison_play_beside_the_drawing_and_are_measured(window, between, baseline):
    session = window.session
    document = between.document
    viewing.compare_with_method(session, baseline)
    window.settle()
    comparison = between.layer_runtime.comparison
    assert comparison.shown.is_current
    assert comparison.shown.clip.baseline is baseline
    own = between.layer_runtime.shown.positions
    distance = np.abs(own - comparison.shown.positions).max() / np.ptp(own.real)
    assert 1e-5 < distance < 0.5
    curves = between.measured.comparison_curves.value
    assert curves.clip.baseline is baseline
    assert np.isfinite(curves.k).all()
    assert between.document is document
    # All frames are there before anybody looks.
    (inbetweens,) = between.layer_runtime.store.prepared(comparison.clip(document))
    assert len(inbetweens._frames) >= LAST - 1


def test_a_method_that_leads_handles_leads_a_new_one(window, between):
    session = window.session
    viewing.compare_with_method(session, Baseline.HANDLES)
    window.settle()
    shown = between.layer_runtime.comparison.shown
    assert shown.is_current
    middle = np.abs(shown.mesh.domain.mesh.vertices - shown.mesh.domain.mesh.vertices.mean())
    add_handle(session, complex(between.layer_runtime.shown.positions[middle.argmin()]))
    window.settle()
    led = between.layer_runtime.comparison.shown
    assert led.is_current
    size = np.ptp(shown.positions.real)
    assert np.abs(led.positions - shown.positions).max() > 1e-3 * size


@pytest.mark.usefixtures("between")
def test_a_method_that_is_not_for_these_keys_says_why(window):
    viewing.compare_with_method(window.session, Baseline.CONFORMAL)
    window.settle()
    (toast,) = window.session.notices.toasts
    assert "conformal" in f"{toast.text} {toast.details}".lower()
    window.session.notices.toasts.clear()


@pytest.mark.usefixtures("between")
def test_side_by_side_each_method_has_half_of_the_viewport(window):
    session = window.session
    whole = session.display.screen
    viewing.toggle_comparison(session)
    viewing.set_side_by_side(session, beside=True)
    window.settle()
    window.frames(2)
    assert session.display.screen[0] == pytest.approx(whole[0] / 2, abs=1)
    assert session.display.screen[1] == whole[1]
    viewing.toggle_comparison(session)
    window.frames(3)
    assert session.display.screen == whole


@pytest.mark.usefixtures("everything")
def test_both_are_measured_and_the_linear_one_leaves_the_bounds(window, between):
    viewing.toggle_comparison(window.session)
    window.show_tab("Measure")
    window.settle()
    own, other = between.measured.curves.value, between.measured.comparison_curves.value
    assert own.k_share.max() <= 1 + 1e-6
    assert own.tau_share.max() <= 1 + 1e-6
    assert other.clip.layer.variant is Variant.LINEAR
    assert other.tau_share.max() > 1.05


def test_a_key_looks_the_same_by_every_method_and_posing_goes_on(window, between):
    session = window.session
    viewing.compare_with_method(session, Variant.NU)
    playback.seek(session, LAST)
    window.settle()
    np.testing.assert_allclose(
        between.layer_runtime.shown.positions,
        between.layer_runtime.comparison.shown.positions,
        rtol=0,
        atol=1e-9,
    )
    middle = between.layer_runtime.shown.mesh.domain.mesh.vertices.mean()
    nearest = np.abs(between.layer_runtime.shown.mesh.domain.mesh.vertices - middle).argmin()
    add_handle(session, complex(between.layer_runtime.shown.positions[nearest]))
    window.settle()
    assert between.layer_runtime.comparison.layer.handles == between.layer.handles


def test_nothing_is_compared_where_the_panel_says_so(window):
    session = window.session
    viewing.compare_with_method(session, Variant.ETA)
    assert session.display.compare_view.method is Variant.ETA
    viewing.compare_with_method(session, None)
    assert session.display.compare_view is None
    viewing.toggle_comparison(session)
    assert session.display.compare_view.method is Variant.ETA
    viewing.move_comparison_divider(session, 2.0)
    assert session.display.compare_view.divider == 1 - viewing.LEAST_PART


@pytest.mark.usefixtures("between")
def test_the_names_of_both_methods_stand_at_the_divider(window):
    session = window.session
    viewing.toggle_theme(session)
    window.frames(3)
    alone = np.asarray(window.picture()).astype(int)
    viewing.toggle_comparison(session)
    window.settle()
    x, top = divider(window)
    changed = np.abs(np.asarray(window.picture()).astype(int) - alone).max(axis=2) > 24
    assert changed[round(top) : round(top) + 500, round(x) - 1 : round(x) + 2].mean() > 0.5
    names = changed[round(top) : round(top) + 40]
    assert names[:, round(x) - 60 : round(x) - 10].mean() > 0.05
    assert names[:, round(x) + 10 : round(x) + 60].mean() > 0.05
