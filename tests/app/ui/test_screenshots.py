"""The main states as pictures: `pytest tests/app/ui/test_screenshots.py --screenshots DIR`."""

from pathlib import Path

import numpy as np
import pytest

from app.document.keyframe import Target
from app.document.settings import Meshing
from app.editor.actions import dialog_actions, editing, playback, viewing
from app.editor.actions.posing.handles import add_handle
from app.editor.actions.posing.pose_drag import set_targets
from app.render import heat_colormap
from app.storage.assets import sample_images
from app.ui.style.theme import PALETTES

SIZES = {"1280": ((1280, 800), 1.0), "2560": ((2560, 1440), 2.0)}
# Where the handles go, as shares of the picture, and by how much two of them move in two keys.
HANDLES = (0.13 + 0.62j, 0.52 + 0.42j, 0.9 + 0.55j, 0.42 + 0.12j)
MOVES = {16: (0.13 + 0.12j, -0.05 + 0.1j), 32: (0.02 - 0.08j, 0.02 - 0.05j)}


@pytest.fixture
def wanted(request):
    """The folder in which somebody wants to look at the screenshots, if anybody does."""
    return request.config.getoption("--screenshots", default=None)


@pytest.fixture
def dragon(window, wanted):
    """The dragon with three keys that nod its head and sweep its tail."""
    session = window.session
    if wanted:
        session.settings.default_meshing = Meshing(triangles=4_000)
    project = window.open(sample_images() / "dragon.png")
    size = complex(*project.document.canvas)

    def scaled(share):
        return complex(share.real * size.real, share.imag * size.imag)

    for share in HANDLES:
        add_handle(session, scaled(share))
        window.frames(2)
    rest = project.layer_runtime.shown.pose.targets
    for frame, (head, tail) in MOVES.items():
        playback.seek(session, frame)
        window.settle()
        moves = {0: head, 2: tail}
        set_targets(
            session,
            {i: Target(position=rest[i].position + scaled(move)) for i, move in moves.items()},
        )
        window.settle()
    editing.select_keys(session, frozenset({16}))
    session.settings.prepares_ahead = True
    window.settle()
    return project


@pytest.fixture
def save(window, wanted, tmp_path):
    """Takes a picture of a state and returns it; asked for, in all themes and sizes."""
    folder = Path(wanted or tmp_path)
    sizes = SIZES if wanted else {"1280": SIZES["1280"]}
    themes = ("light", "dark") if wanted else ("dark",)
    folder.mkdir(parents=True, exist_ok=True)

    def take(state):
        for size, (pixels, scale) in reversed(sizes.items()):
            window.resize(pixels, scale)
            for theme in themes:
                if window.session.settings.preferences.theme != theme:
                    viewing.toggle_theme(window.session)
                window.settle()
                window.frames(10)
                picture = window.picture()
                picture.save(folder / f"{state}-{theme}-{size}.png")
        return np.asarray(picture).astype(int)  # the dark one at 1280 pixels

    return take


def near(picture, colour, tolerance=6):
    """Return where a picture has a colour of the theme."""
    level = [round(255 * channel) for channel in (colour.x, colour.y, colour.z)]
    return np.abs(picture - level).max(axis=2) <= tolerance


def around(window, picture, place, reach=9):
    """Return what a picture shows around a place of the drawing."""
    point = window.point(place)
    x, y = round(point.x), round(point.y)
    return picture[y - reach : y + reach + 1, x - reach : x + reach + 1]


def in_viewport(picture):
    return picture[40:570, 60:890]


def differs(picture, other):
    """Return which share of a picture is not as another."""
    return float((np.abs(picture - other).max(axis=2) > 12).mean())


def test_screenshots_of_the_main_states(window, dragon, save):
    session, palette = window.session, PALETTES["dark"]
    playback.seek(session, 16)
    editing.select_handles(session, frozenset({0}))
    posing_ = save("posing")
    for number, place in enumerate(dragon.layer_runtime.shown.handle_positions):
        mark = around(window, posing_, complex(place))
        assert (mark.min(axis=2) > 225).sum() > 8, number
        is_blue = (mark[..., 2] > 200) & (mark[..., 0] < 90)
        assert (is_blue.sum() > 20) == (number != 0), number  # the selected one is yellow
    assert near(posing_, palette.accent).sum() > 300  # playhead, switches, slider

    playback.seek(session, 10)
    plain = in_viewport(save("plain"))
    viewing.toggle_overlay(session, "onion")
    ghosts = in_viewport(save("onion-skin"))
    tint = (ghosts - plain)[..., 0] - (ghosts - plain)[..., 2]
    assert (tint > 20).sum() > 1000  # red before
    assert (tint < -20).sum() > 1000  # blue after
    assert differs(ghosts, plain) < 0.2

    viewing.toggle_overlay(session, "onion")
    playback.seek(session, 16)
    viewing.show_heat_map(session, "sigma_b")
    window.show_tab("Measure")
    heat = save("heat-map")
    is_drawn = np.abs(in_viewport(posing_) - in_viewport(heat)).max(axis=2) > 12
    assert is_drawn.mean() > 0.1  # all of the dragon, and nothing around it
    assert is_drawn.mean() < 0.5
    ramp = heat_colormap()[::16].astype(int)
    panel = heat[60:200, 980:1270]
    missing = [tone for tone in ramp if (np.abs(panel - tone).max(axis=2) < 10).sum() < 3]
    assert len(missing) <= 2
    # Two limits; their lines may lie between two rows of pixels.
    assert near(heat[280:560, 980:1270], palette.danger, 45).sum() > 300

    viewing.show_heat_map(session, "none")
    window.show_tab("Export")
    export = save("export")
    low, high = session.export.frame_box
    for share in (0.2, 0.5, 0.8):
        for edge in (
            complex(low.real + share * (high - low).real, low.imag),
            complex(low.real, low.imag + share * (high - low).imag),
        ):
            # The line may lie between two pixels.
            assert near(around(window, export, edge, 3), palette.accent, 50).any()

    window.show_tab("Handle")
    session.notices.show(
        "cow.png cannot be opened: it is damaged or cut short. Save it again, or take another.",
        tone="error",
    )
    error = save("error")
    assert near(error[500:650, 40:440], palette.danger).sum() > 100
    assert near(error[500:650, 40:440], palette.raised).mean() > 0.05
    assert not near(posing_[600:, 900:], palette.danger).any()

    session.notices.toasts = []
    dialog_actions.show_shortcuts(session)
    sheet = save("shortcuts")
    assert near(sheet[150:650, 150:1130], palette.text, 40).mean() > 0.005
    assert in_viewport(sheet)[:30].mean() < 0.75 * in_viewport(posing_)[:30].mean()  # dimmed

    dialog_actions.close_dialog(session)
    session.project = None
    welcome = save("welcome")
    colours = welcome.max(axis=2) - welcome.min(axis=2)
    columns = (colours[390:470] > 60).any(axis=0)
    assert (np.diff(columns.astype(int)) == 1).sum() >= 4  # a row of pictures with gaps
    assert near(welcome[150:210], palette.accent).sum() > 3000  # the button
