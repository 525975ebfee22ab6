"""How soon the picture answers, in frames."""

from itertools import count

from app.document.keyframe import Target
from app.editor.actions import posing


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
