"""The player in a real browser: what it shows, and how it is moved."""

import base64
import io
from dataclasses import replace

import numpy as np
import pytest
from animations import moving_document
from chromium import PROGRAM, Page, chromium
from documents import altered
from PIL import Image
from slid_poses import slid
from sound_files import sine, sound, wav

from app.document import (
    BLENDS,
    LAYER_KINDS,
    TRANSFORM,
    VISIBILITY,
    Document,
    ExportSettings,
    FrameRange,
    Group,
    Transform,
)
from app.export import ExportRequest, FrameRenderer, MeshExport, plan_export
from app.motion import Evaluator
from app.render.gpu.context import create_context
from app.storage import decode_picture
from engine.arrays import Bytes

if PROGRAM is None:
    pytest.skip(
        "no Chromium here: bash .ci/setup test installs it where it is a package",
        allow_module_level=True,
    )

SIZE = (240, 200)
MOMENTS = (0.0, 0.11, 0.2)  # seconds
# Levels, premultiplied, of any pixel and of the mean: textures of browsers have 8 bits.
MOST, MEAN = 6, 0.3


@pytest.fixture(scope="module")
def browser(tmp_path_factory):
    with chromium(tmp_path_factory.mktemp("profile")) as page:
        yield page


def two_blobs() -> Document:
    """Two layers of which one lies faintly over the other until it is hidden, in a loop."""
    document = moving_document()
    (layer,) = document.layers
    switches = (VISIBILITY.key(0, value=True), VISIBILITY.key(3, value=False))
    above = replace(layer, id=1, name="above", opacity=0.6, keys=layer.keys[:1])
    above = above.with_keys_of(VISIBILITY, switches)
    return replace(document, layers=(layer, above), frames=FrameRange(0, 8), loop=True)


def exported(document, out, **settings):
    """Export a page; return how the renderer draws a frame of it."""
    chosen = ExportSettings(format="html", size=SIZE, **settings)
    request = ExportRequest(out=out, settings=chosen, project="walk")
    evaluator = Evaluator.exact(document)
    pictures = {f.id: decode_picture(f.picture.data, "").rgba for f in document.layers}
    plan = plan_export(document, request, evaluator)
    list(MeshExport(document, pictures, evaluator, plan).run())

    def draw(gl, frame) -> Bytes:
        painter = FrameRenderer(gl, document, pictures, evaluator, plan)
        picture = painter.draw(painter.pose(frame))
        painter.release()
        return picture

    return draw


def opened(browser: Page, out, size=SIZE) -> Page:
    browser.open(out, size)
    browser.run(
        "new Promise(done => { const look = () => lissom.ready ? done() : setTimeout(look, 5);"
        " look(); })"
    )
    return browser


def shown(page: Page, seconds: float) -> Bytes:
    script = f"lissom.show({seconds}); document.querySelector('canvas').toDataURL()"
    data = base64.b64decode(page.run(script).partition(",")[2])
    with Image.open(io.BytesIO(data)) as image:
        return np.asarray(image.convert("RGBA"))


def premultiplied(picture: Bytes):
    colours = picture.astype(np.float64)
    colours[..., :3] *= colours[..., 3:] / 255
    return colours


def press(page: Page, kind: str, x: float, y: float = 100) -> None:
    page.say(
        "Input.dispatchMouseEvent",
        type=kind,
        x=x,
        y=y,
        button="left",
        buttons=1,
        clickCount=1,
    )


def test_the_browser_shows_what_the_renderer_draws(browser, tmp_path):
    document, out = two_blobs(), tmp_path / "walk.html"
    draw = exported(document, out)
    page, gl = opened(browser, out), create_context()
    page.run("lissom.pause()")
    for seconds in MOMENTS:
        found, wanted = shown(page, seconds), draw(gl, document.fps * seconds)
        assert found.shape == wanted.shape
        apart = np.abs(premultiplied(found) - premultiplied(wanted))
        assert apart.max() <= MOST, seconds
        assert apart.mean() <= MEAN, seconds
        assert found[0, 0, 3] == 0
    assert np.abs(premultiplied(shown(page, 0)) - premultiplied(found)).max() > 100
    gl.release()
    assert page.run("gl.getError()") == 0


def test_layers_that_turn_as_a_whole_move_in_a_page(browser, tmp_path):
    document, out = two_blobs(), tmp_path / "turn.html"
    turns = (
        TRANSFORM.key(0, Transform(scale=0.8)),
        TRANSFORM.key(4, Transform(12 - 9j, 1.9, 1.2)),
        TRANSFORM.key(8, Transform(scale=0.8)),
    )
    document = document.with_layer(document.layer(1).with_keys_of(TRANSFORM, turns))
    draw = exported(document, out)
    page, gl = opened(browser, out), create_context()
    page.run("lissom.pause()")
    pictures = []
    for seconds in (0.0, 0.06, 0.11):
        found, wanted = shown(page, seconds), draw(gl, document.fps * seconds)
        pictures.append(premultiplied(found))
        # Edges may lie a tenth of the tolerance beside their place.
        assert np.abs(pictures[-1] - premultiplied(wanted)).mean() <= 2 * MEAN
    gl.release()
    assert np.abs(pictures[-1] - pictures[0]).mean() > 10 * MEAN


def test_sliders_move_a_page(browser, tmp_path):
    document, out = replace(slid(-1, 1.2), frames=FrameRange(0, 10)), tmp_path / "nod.html"
    draw = exported(document, out)
    page, gl = opened(browser, out), create_context()
    page.run("lissom.pause()")
    pictures = []
    for seconds in MOMENTS:
        found, wanted = shown(page, seconds), draw(gl, document.fps * seconds)
        pictures.append(premultiplied(found))
        # But for single pixels of the edge, which is opaque.
        assert np.abs(pictures[-1] - premultiplied(wanted)).mean() <= 2 * MEAN
    gl.release()
    assert np.abs(pictures[-1] - pictures[0]).mean() > 50 * MEAN


@pytest.mark.parametrize("background", ["transparent", "#c08030"])
def test_the_browser_composites_as_the_renderer_does(browser, tmp_path, background):
    document, out = two_blobs(), tmp_path / "walk.html"
    (low, high), tint = document.layers, LAYER_KINDS["tint"]
    made = [
        replace(low, name="base", opacity=0.8),
        replace(high, id=1, name="shade", clipped=True, blend="soft-light"),
        replace(high, id=2, name="far", blend="luminosity", group="limbs").with_keys_of(
            tint, [tint.key(0, (0.5, 0.8, 1.0))]
        ),
        replace(low, id=3, name="near", opacity=1.0, group="limbs/inner"),
        replace(high, id=4, name="light", clipped=True, blend="multiply", group="limbs/inner"),
    ]
    groups = (Group(name="limbs", opacity=0.6), Group(name="limbs/inner", blend="difference"))
    document = replace(document, layers=tuple(made), groups=groups)
    draw = exported(document, out, background=background)
    page, gl = opened(browser, out), create_context()
    page.run("lissom.pause()")
    for seconds in MOMENTS[::2]:  # with what is hidden later, and without it
        found, wanted = shown(page, seconds), draw(gl, document.fps * seconds)
        apart = np.abs(premultiplied(found) - premultiplied(wanted))
        assert apart.max() <= 2 * MOST, seconds
        assert apart.mean() <= 2 * MEAN, seconds
    gl.release()
    assert page.run("gl.getError()") == 0


def test_the_browser_has_a_program_for_every_blend_mode(browser, tmp_path):
    out = tmp_path / "walk.html"
    exported(moving_document(), out)
    page = opened(browser, out)
    linked = f"{list(BLENDS)}.filter(b => gl.getProgramParameter(wholeOf(b), gl.LINK_STATUS))"
    assert page.run(linked) == list(BLENDS)


def test_it_fits_its_frame_whatever_that_is(browser, tmp_path):
    out = tmp_path / "walk.html"
    exported(moving_document(), out)
    small = shown(opened(browser, out), 0.1)
    high = shown(opened(browser, out, (120, 400)), 0.1)
    assert high.shape == (400, 120, 4)
    boxes = [np.argwhere(picture[..., 3] > 128) for picture in (small, high)]
    (first, second) = (box.max(axis=0) - box.min(axis=0) for box in boxes)
    assert np.abs(second - first / 2).max() <= 2
    assert abs(boxes[1].mean(axis=0)[0] - 200) < 40


def test_it_plays_and_is_paused_scrubbed_and_stepped(browser, tmp_path):
    document, out = two_blobs(), tmp_path / "a <walk> & run.html"
    exported(document, out)
    page = opened(browser, out)
    assert page.run("document.title") == "a <walk> & run"
    assert page.run("lissom.playing")
    page.run(
        "new Promise(done => { const from = lissom.time, look = () =>"
        " lissom.time != from ? done() : requestAnimationFrame(look); look(); })"
    )
    press(page, "mousePressed", 100)
    press(page, "mouseReleased", 100)
    assert not page.run("lissom.playing")
    page.run("lissom.show(0.1)")
    press(page, "mousePressed", 100)
    press(page, "mouseMoved", 160)
    quarter = 0.25 * 8 / document.fps
    assert page.run("lissom.time") == pytest.approx(0.1 + quarter)
    press(page, "mouseMoved", 280)  # a loop comes round
    assert page.run("lissom.time") == pytest.approx(0.1 + 3 * quarter - 8 / document.fps)
    press(page, "mouseReleased", 280)
    assert not page.run("lissom.playing")
    for key in ("ArrowRight", "ArrowRight", "ArrowLeft"):
        page.say("Input.dispatchKeyEvent", type="keyDown", key=key)
    stepped = 0.1 + 3 * quarter - 8 / document.fps + 1 / document.fps
    assert page.run("lissom.time") == pytest.approx(stepped)
    page.say("Input.dispatchKeyEvent", type="keyDown", key=" ")
    assert page.run("lissom.playing")


def test_it_stands_still_for_whom_motion_is_too_much(browser, tmp_path):
    out = tmp_path / "walk.html"
    exported(moving_document(), out, background="#102030")
    feature = [{"name": "prefers-reduced-motion", "value": "reduce"}]
    browser.say("Emulation.setEmulatedMedia", features=feature)
    page = opened(browser, out)
    assert not page.run("lissom.playing")
    assert page.run("getComputedStyle(document.body).backgroundColor") == "rgb(16, 32, 48)"
    page.say("Emulation.setEmulatedMedia", features=[])
    page.run("lissom.play()")
    assert page.run("lissom.playing")


def test_what_plays_once_ends_and_plays_again(browser, tmp_path):
    out = tmp_path / "walk.html"
    exported(moving_document(), out)
    page = opened(browser, out)
    page.run(
        "new Promise(done => { const look = () => lissom.playing ? requestAnimationFrame(look)"
        " : done(); look(); })"
    )
    assert page.run("lissom.time") == page.run("lissom.seconds") == 0.25
    page.run("lissom.play()")
    assert page.run("lissom.time < lissom.seconds")


def test_a_lost_context_comes_back(browser, tmp_path):
    out = tmp_path / "walk.html"
    exported(moving_document(), out)
    page = opened(browser, out)
    page.run("lissom.pause()")
    before = shown(page, 0.1)
    page.run(
        "const lose = gl.getExtension('WEBGL_lose_context'); lose.loseContext();"
        "new Promise(done => { canvas.addEventListener('webglcontextrestored', done);"
        " setTimeout(() => lose.restoreContext(), 1); })"
    )
    assert (shown(page, 0.1) == before).all()


def test_what_lies_in_front_changes_when_it_should(browser, tmp_path, monkeypatch):
    document, out = moving_document(), tmp_path / "walk.html"
    first = document.layers[0].domain.mesh.triangles
    then = first[::-1].copy()
    monkeypatch.setattr(
        "app.export.morph_mesh.TriangleOrder.triangles", lambda _, __, n: first if n < 3 else then
    )
    exported(document, out)
    page = opened(browser, out)
    for frame, order in ((0, first), (2.9, first), (3, then), (1, first)):
        page.run(f"lissom.pause(); lissom.show({frame / document.fps + 1e-6})")
        assert page.run("[...figures[0].order.slice(0, 3)]") == order[0].tolist()


def test_a_still_and_a_page_without_motion(browser, tmp_path):
    document, out = moving_document(), tmp_path / "walk.html"
    still = altered(document, keys=document.layers[0].keys[:1])
    exported(still, out)
    page = opened(browser, out)
    assert shown(page, 3.0)[..., 3].max() == 255


def test_the_sound_of_a_page_leads_its_picture(browser, tmp_path):
    talk = sound(wav(sine(2.0)))
    document, out = replace(two_blobs(), sounds=(talk,), fps=8.0), tmp_path / "a.html"
    exported(document, out)
    page = opened(browser, out)
    page.run("new Promise(done => voice.readyState ? done() : voice.onloadedmetadata = done)")
    assert page.run("voice.duration") == pytest.approx(1.0)
    page.run("lissom.pause(); lissom.show(0.25)")
    assert page.run("voice.currentTime") == pytest.approx(0.25)
    # A player that stands at another time: the picture goes there.
    page.run(
        "new Promise(done => { playing = true; Object.defineProperty(voice, 'paused', "
        "{ get: () => false }); voice.currentTime = 0.5; step(0); playing = false; done(); })"
    )
    assert page.run("lissom.time") == pytest.approx(0.5)
