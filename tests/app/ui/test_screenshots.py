"""The main states as pictures: `pytest tests/ui/test_ui_screenshots.py --screenshots DIR`."""

from pathlib import Path

import numpy as np
import pytest

from app.document.keyframe import Target
from app.document.settings import Meshing
from app.editor.actions import editing, playback, posing, viewing
from app.storage.assets import sample_images

SIZES = {"1280": ((1280, 800), 1.0), "2560": ((2560, 1440), 2.0)}
# Where the handles go, as shares of the picture, and by how much two of them move in two keys.
HANDLES = (0.13 + 0.62j, 0.52 + 0.42j, 0.9 + 0.55j, 0.42 + 0.12j)
MOVES = {16: (0.13 + 0.12j, -0.05 + 0.1j), 32: (0.02 - 0.08j, 0.02 - 0.05j)}


@pytest.fixture
def dragon(window):
    """The dragon with three keys that nod its head and sweep its tail."""
    session = window.session
    session.meshing = Meshing(triangles=12_000)
    project = window.open(sample_images() / "dragon.png")
    size = complex(*project.document.canvas)

    def scaled(share):
        return complex(share.real * size.real, share.imag * size.imag)

    for share in HANDLES:
        posing.add_handle(session, scaled(share))
        window.frames(2)
    rest = project.puppet.shown.pose.targets
    for frame, (head, tail) in MOVES.items():
        playback.seek(session, frame)
        window.settle()
        wishes = {0: head, 2: tail}
        posing.wish(
            session,
            {i: Target(position=rest[i].position + scaled(move)) for i, move in wishes.items()},
        )
        window.settle()
    editing.choose_keys(session, frozenset({16}))
    return project


@pytest.fixture
def save(window, request, tmp_path):
    """Takes a picture of a state, which must show something; asked for, in all themes and sizes."""
    wanted = request.config.getoption("--screenshots", default=None)
    folder = Path(wanted or tmp_path)
    sizes = SIZES if wanted else {"1280": SIZES["1280"]}
    themes = ("dark", "light") if wanted else ("dark",)
    folder.mkdir(parents=True, exist_ok=True)

    def take(state):
        for size, (pixels, scale) in sizes.items():
            window.resize(pixels, scale)
            for theme in themes:
                if window.session.preferences.theme != theme:
                    viewing.toggle_theme(window.session)
                window.settle()
                window.frames(10)
                picture = window.picture()
                picture.save(folder / f"{state}-{theme}-{size}.png")
                assert len(np.unique(np.asarray(picture).reshape(-1, 3), axis=0)) > 50
        window.resize(SIZES["1280"][0])

    return take


def test_screenshots_of_the_main_states(window, dragon, save):  # noqa: ARG001
    session = window.session
    playback.seek(session, 16)
    editing.select(session, frozenset({0}))
    save("posing")
    viewing.toggle(session, "onion")
    playback.seek(session, 10)
    save("onion-skin")
    viewing.toggle(session, "onion")
    playback.seek(session, 16)
    viewing.show_heat_map(session, "sigma_b")
    window.show_tab("Distortion")
    save("heat-map")
    viewing.show_heat_map(session, "none")
    window.show_tab("Export")
    save("export")
    window.show_tab("Handle")
    session.tell(
        "cow.png cannot be opened: it is damaged or cut short. Save it again, or take another.",
        tone="error",
    )
    save("error")
    session.toasts = []
    viewing.show_shortcuts(session)
    save("shortcuts")
    viewing.close_dialog(session)
    session.project = None
    save("welcome")
