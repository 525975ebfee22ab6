"""A drawing with groups, modes and clipped layers, from its file to a frame and a thumbnail."""

from dataclasses import replace

import numpy as np
import pytest
from layered import blob, openraster
from numpy.testing import assert_allclose
from PIL import Image

from app.document import ExportSettings, Meshing
from app.export import ExportRequest, FrameRenderer, plan_export
from app.motion import Evaluator
from app.render.gpu.context import create_context
from app.storage import cut_picture, flatten_layers, open_layered

SIZE = (160, 120)
# From the front: pictures, their places, and what is said of them.
LAYERS = {
    "glow": (blob(60, 60, (250, 220, 90)), (80, 20), 'composite-op="svg:screen" opacity="0.7"'),
    "near": (blob(50, 80, (40, 160, 60)), (30, 20), ""),
    "far": (blob(80, 40, (30, 60, 200)), (20, 50), ""),
    "shade": (blob(70, 70, (120, 90, 160)), (70, 60), 'composite-op="svg:multiply"'),
    "light": (blob(40, 60, (240, 250, 200)), (110, 40), 'composite-op="svg:src-atop"'),
    "body": (blob(70, 90, (200, 90, 40)), (75, 20), 'opacity="0.9"'),
    "sky": (Image.new("RGBA", SIZE, (150, 190, 240, 255)), (0, 0), ""),
}


@pytest.fixture(scope="module")
def opened(tmp_path_factory):
    tags = [
        f'<layer name="{name}" src="data/{number}.png" x="{x}" y="{y}" {said}/>'
        for number, (name, (_, (x, y), said)) in enumerate(LAYERS.items())
    ]
    glow, near, far, shade, light, body, sky = tags
    stack = (
        f'{glow}<stack name="limbs" opacity="0.5">{near}{far}</stack>'
        f'<stack name="trunk" isolation="isolate">{shade}{light}{body}</stack>{sky}'
    )
    path = tmp_path_factory.mktemp("layered") / "walk.ora"
    path.write_bytes(openraster(SIZE, stack, [picture for picture, _, _ in LAYERS.values()]))
    scene = open_layered(path, Meshing(triangles=1_000, detail="coarse"))
    assert not scene.document.import_log.warnings
    return scene


def on_canvas(name):
    picture, place, _ = LAYERS[name]
    canvas = Image.new("RGBA", SIZE)
    canvas.paste(picture, place)
    pixels = np.asarray(canvas) / 255
    return pixels[..., :3] * pixels[..., 3:], pixels[..., 3:]


def over(below, above, opacity=1.0):
    (b, alpha_b), (s, alpha_s) = below, (each * opacity for each in above)
    return s + (1 - alpha_s) * b, alpha_s + (1 - alpha_s) * alpha_b


def expected():
    """All in premultiplied colours: the formulas of the W3C, and nothing of ours."""
    sky, body, light, shade, far, near, glow = map(on_canvas, reversed(LAYERS))
    b, alpha_b = body
    # Clipped by the body alone, then faded with it; the group keeps what is multiplied in it.
    (s, alpha_s) = light
    trunk = (s * alpha_b + (1 - alpha_s) * b) * 0.9, alpha_b * 0.9
    b, alpha_b = trunk
    s, alpha_s = shade
    trunk = (
        (1 - alpha_b) * s + s * b + (1 - alpha_s) * b,
        alpha_s + alpha_b - alpha_s * alpha_b,
    )
    flat = over(over(sky, trunk), over(far, near), 0.5)
    b, s = flat[0], 0.7 * glow[0]
    return b + s - b * s


def test_a_frame_looks_as_the_file_says(opened, tmp_path):
    document = opened.document
    settings = ExportSettings(format="picture", framing="canvas")
    request = ExportRequest(out=tmp_path / "a.png", settings=settings, project="walk")
    evaluator = Evaluator.exact(document)
    pictures = {identity: picture.rgba for identity, picture in opened.pictures.items()}
    context = create_context()
    painter = FrameRenderer(
        context, document, pictures, evaluator, plan_export(document, request, evaluator)
    )
    frame = painter.draw(painter.pose(0))
    painter.release()
    context.release()
    assert_allclose(frame[..., :3] / 255, expected(), rtol=0, atol=2.5 / 255)


def small(opened, document):
    textures = {
        layer.id: cut_picture(opened.pictures[layer.id], layer.cut_out).texture
        for layer in document.layers
    }
    return flatten_layers(document, textures)


def test_the_small_picture_of_a_project_does_too(opened):
    flat = small(opened, opened.document)
    assert_allclose(flat[..., :3] / 255, expected(), rtol=0, atol=4 / 255)


def test_what_blends_in_a_faded_group_meets_what_lies_behind_it_where_it_passes_through(opened):
    def flat(**changes):
        groups = [
            replace(group, **changes) if group.name == "trunk" else group
            for group in opened.document.groups
        ]
        return small(opened, replace(opened.document, groups=tuple(groups))).astype(float)

    whole, gone = flat(blend="pass-through"), flat(hidden=True)
    # The sky is multiplied by the shade.
    assert (whole < gone - 20).any()
    half = flat(blend="pass-through", opacity=0.5)
    assert_allclose(half, (whole + gone) / 2, rtol=0, atol=3)
    assert (abs(flat(opacity=0.5) - half) > 10).any()
