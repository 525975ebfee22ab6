"""How soon the picture answers, in frames."""

from itertools import count

import numpy as np

from app.document.keyframe import Target
from app.editor.actions import editing, playback, posing


def pull(window, bar, by):
    """Pull a handle, and let the solver be as quick as can be."""
    wish = Target(position=bar.document.figures[0].handle(1).position + by)
    assert window.session.jobs.settle()
    window.act(posing.pull, {1: wish})
    assert window.session.jobs.settle()
    window.frames()
    return wish


def test_the_picture_follows_a_pull_in_the_next_frame(window, bar):
    for step in range(1, 6):
        wish = pull(window, bar, 40j * step)
        assert bar.puppet.shown.pose.targets[1] == wish


def test_a_slow_solver_shows_every_step(window, bar):
    window.session.clock = count().__next__  # each look at the clock takes a second
    pull(window, bar, 40j)
    assert bar.posing.steps == 1
    # Nor does the picture wait while the hand rests.
    for steps in (2, 3):
        assert window.session.jobs.settle()
        window.frames()
        assert bar.posing.steps == steps


def test_a_hand_that_moves_sees_every_step(window, bar):
    for step in range(1, 6):
        pull(window, bar, 40j * step)
        assert 1 <= bar.posing.steps <= posing.STEPS


def test_a_hand_that_rests_gets_as_many_steps_as_fit_before_the_next_picture(window, bar):
    pull(window, bar, 60j)
    assert not bar.posing.drag.is_over
    # The clock stands still while the worker computes: all of them fit.
    assert window.session.jobs.settle()
    window.frames()
    assert bar.posing.drag.is_over
    assert bar.posing.steps > posing.STEPS


def test_nothing_moves_once_the_pose_rests(window, bar):
    pull(window, bar, 60j)
    assert not bar.posing.is_at_rest
    window.settle()
    assert bar.posing.is_at_rest
    rested, shown = bar.document, bar.puppet.shown.positions
    window.frames(20)
    assert posing.POSING not in window.session.jobs.kinds
    window.act(posing.let_go)
    window.settle()
    window.frames(20)
    assert bar.posing is None
    assert bar.document is rested
    np.testing.assert_array_equal(bar.puppet.shown.positions, shown)


def test_in_betweens_are_exact_while_the_pose_that_was_left_comes_to_rest(window, bent):
    window.session.clock = count().__next__
    wish = pull(window, bent, 80j)
    window.act(playback.scrub, 12)
    exact = []
    while bent.settling is not None:
        assert window.session.jobs.settle()
        window.frames()
        shown = bent.puppet.shown
        assert (shown.frame, shown.clip) == (12, bent.clip)
        exact.append(shown.is_current)
        assert len(exact) < 200
    # Rough ones before the first exact one, and none after it.
    assert exact.index(True) <= 2
    assert all(exact[exact.index(True) :])
    assert len(exact) > 4
    pose = bent.figure.key(24).pose
    assert pose.targets[1] == wish
    place = bent.figure.map_of(pose)(np.array([bent.figure.handle(1).position]))[0]
    assert abs(place - wish.position) < 2
    window.act(editing.undo)
    assert bent.figure.key(24).pose.targets[1] != wish
