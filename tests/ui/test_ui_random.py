"""A random walk over what a person can do, which nothing may break."""

import numpy as np
import pytest

from app.actions import editing, keys, playback, posing, viewing
from app.assets import sample_images
from app.document import key_commands
from app.document.easing import PRESETS
from app.document.keyframe import Target
from app.document.settings import VARIANTS

STEPS = 150


def pull_one(session, rng):
    project = session.project
    if project.shown is None:
        return
    # What is shown may be a frame behind the document.
    shown = dict(zip(project.shown.document.handles, project.shown.handle_places, strict=True))
    handles = [handle for handle in project.document.handles if handle in shown]
    if not handles:
        return
    handle = handles[rng.integers(len(handles))]
    place = shown[handle]
    offset = complex(*rng.normal(0, 40, 2))
    posing.wish(session, {handle.id: Target(position=complex(place) + offset)})


def add_one(session, rng):
    project = session.project
    if project.shown is not None and len(project.document.handles) < 6:
        vertices = project.shown.positions
        posing.add_handle(session, complex(vertices[rng.integers(len(vertices))]))


def choose_some(session, rng):
    frames = [key.frame for key in session.project.document.keys]
    editing.choose_keys(session, frozenset(f for f in frames if rng.random() < 0.5))


def move_some(session, rng):
    chosen = session.project.chosen
    editing.edit(session, key_commands.move_keys(chosen, int(rng.integers(-5, 6))))


ACTIONS = (
    (add_one, 3),
    (pull_one, 6),
    (lambda s, r: playback.seek(s, int(r.integers(0, 60))), 4),
    (lambda s, _: playback.toggle_play(s), 1),
    (lambda s, r: playback.to_key(s, int(r.choice([-1, 1]))), 1),
    (lambda s, _: posing.insert_key(s), 2),
    (lambda s, _: editing.undo(s), 3),
    (lambda s, _: editing.redo(s), 1),
    (lambda s, _: editing.select_all(s), 1),
    (choose_some, 2),
    (lambda s, _: editing.delete(s), 1),
    (move_some, 1),
    (lambda s, _: keys.reverse(s), 1),
    (lambda s, _: keys.match_ends(s), 1),
    (lambda s, _: keys.toggle_loop(s), 1),
    (lambda s, r: keys.set_variant(s, str(r.choice([v for v in VARIANTS if v != "metric"]))), 1),
    (lambda s, r: keys.set_easing(s, s.project.chosen, PRESETS[str(r.choice(list(PRESETS)))]), 1),
    (lambda s, _: viewing.toggle(s, "onion"), 1),
    (lambda s, _: viewing.toggle_heat_map(s), 1),
    (lambda s, _: viewing.toggle_auto_key(s), 1),
    (lambda s, _: viewing.toggle_theme(s), 1),
)


@pytest.mark.parametrize("seed", [1, 2])
def test_random_walk_ends_where_it_began(window, seed):
    session = window.session
    project = window.open(sample_images() / "bar.png")
    first = project.document
    keys.set_variant(session, "nu")
    rng = np.random.default_rng(seed)
    verbs = [verb for verb, _ in ACTIONS]
    odds = np.array([weight for _, weight in ACTIONS], dtype=float)
    for _ in range(STEPS):
        verb = verbs[rng.choice(len(verbs), p=odds / odds.sum())]
        window.act(verb, rng)
        window.frames(int(rng.integers(0, 4)))
    window.settle()
    details = [toast.details for toast in session.toasts if toast.details]
    assert details == []
    while project.history.undo_label is not None:
        window.act(editing.undo)
    assert project.document is first
