"""Every verb of the actions' table works on whatever there is, or says why not."""

from contextlib import suppress

import numpy as np
import pytest
from harness import own
from invariants import check_invariants
from projects import project_of
from scenes import PICTURE, random_scene, random_state

from app.editor.actions.project_files import saving
from app.errors import EXPECTED_ERRORS
from app.ui.shortcuts.table import ACTIONS

TABS = ("Handle", "Layers", "Animate", "Shape", "Export", "Measure")
DRAWN = 3  # verbs of each document after which the window is drawn
SEEDS = (*range(3), *(pytest.param(seed, marks=pytest.mark.long) for seed in range(3, 16)))
EACH = 4  # documents of a seed
CLOSES = {"Close", "Quit"}


@pytest.fixture
def alone(monkeypatch):
    """Nothing beside the window is opened."""
    monkeypatch.setattr("webbrowser.open", lambda *_: True)


def put(window, project, rng):
    """Show a copy of a project in a random state, with nothing under way."""
    session = window.session
    for kind in session.jobs.kinds:
        session.jobs.drop(kind)
    session.dialogs.current = session.export.run = session.tutorial.state = None
    session.tools.active_tool = None
    session.is_quitting, session.notices.toasts = False, []
    saving.set_project(session, own(project))
    random_state(rng, session, session.project)


def apply(session, name):
    """Do what a menu entry does, unless it says why not."""
    with suppress(*EXPECTED_ERRORS):
        if ACTIONS[name].disabled_reason(session) is None:
            ACTIONS[name].menu_title(session)
            ACTIONS[name].action.apply(session)


@pytest.mark.usefixtures("alone")
@pytest.mark.parametrize("seed", SEEDS)
def test_verbs_work_on_random_documents_or_say_why_not(window, seed):
    rng, session = np.random.default_rng(seed), window.session
    with session.jobs.held():
        for number in range(EACH):
            project = project_of(random_scene(rng), PICTURE, "scene")
            window.show_tab(TABS[rng.integers(len(TABS))])
            drawn = set(rng.choice(list(ACTIONS), DRAWN))
            for name in ACTIONS:
                put(window, project, rng)
                walk = seed, number, name
                try:
                    apply(session, name)
                    if name in drawn:
                        window.frames()
                except Exception as error:
                    raise AssertionError(walk) from error
                surprises = [toast.details for toast in session.notices.toasts if toast.details]
                assert not surprises, (walk, surprises[0])
                if name not in CLOSES:
                    check_invariants(session)
            session.is_quitting = False
    saving.set_project(session, None)
    session.is_quitting, session.dialogs.current = False, None
