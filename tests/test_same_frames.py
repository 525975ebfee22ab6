"""The window shows the frames that an export has, wherever both have the same triangles."""

from dataclasses import replace

import numpy as np
import pytest
from sessions import go, session_of

from app.motion import Evaluator
from app.storage import decode_picture, load_project
from app.storage.assets import sample_images

NEAR = 0.05  # thousandths of the drawing's longer side
OTHERS = sorted({path.stem for path in sample_images().glob("*.lissom")} - {"ring"})
SHARES = (0.0, 0.13, 0.4, 0.5, 0.77, 1.0)  # of the animation, at which frames are compared


def exported(document, meshes, frames):
    """Return where an export has each layer in the scene, on other meshes, by frame."""
    layers = [
        replace(layer, domain=replace(layer.domain, mesh=meshes[layer.id].domain.mesh))
        for layer in document.layers
    ]
    same = replace(document, layers=tuple(layers))
    evaluator, ids = Evaluator.exact(same), list(meshes)
    return {
        frame: {
            i: each.scene_positions
            for i, each in evaluator.evaluate(same, frame, only=ids).layers.items()
        }
        for frame in frames
    }


@pytest.mark.parametrize(
    "name", ["ring", *(pytest.param(name, marks=pytest.mark.long) for name in OTHERS)]
)
def test_window_shows_the_frames_of_an_export(name, tmp_path):
    document = load_project(sample_images() / f"{name}.lissom")
    first = document.layers[0]
    picture = decode_picture(first.picture.data, first.name).rgba
    session = session_of(document, tmp_path, picture, prepares_ahead=True)
    runtimes, whole = session.project.runtimes.layers, document.frames
    frames = [round(whole.first + share * (whole.last - whole.first)) for share in SHARES]
    meshes = {i: runtime.shown.mesh for i, runtime in runtimes.items()}
    for frame, wanted in exported(document, meshes, frames).items():
        go(session, frame)
        for i, runtime in runtimes.items():
            assert runtime.shown.is_current
            assert runtime.shown.mesh is meshes[i]
            drawn = runtime.shown.scene_positions
            assert np.abs(drawn - wanted[i]).max() < NEAR * max(document.canvas) / 1000, (i, frame)
