"""The window shows the frames that an export has, wherever both have the same triangles."""

import numpy as np
import pytest
from sessions import go, session_of

from app.document import clip_of
from app.motion import Animation, ParentTransforms
from app.storage import decode_picture, load_project
from app.storage.assets import sample_images

NEAR = 0.05  # thousandths of the drawing's longer side
SAMPLES = sorted(path.stem for path in sample_images().glob("*.lissom"))
SHARES = (0.0, 0.13, 0.4, 0.5, 0.77, 1.0)  # of the animation, at which frames are compared


def exported(document, meshes, frame):
    """Return where an export has the vertices of the window's meshes in the scene, by layer."""
    animations = {
        layer.id: Animation(
            clip_of(document, layer.id), points=meshes[layer.id].domain.mesh.vertices
        )
        for layer in document.layers
    }
    joints = ParentTransforms(document, {i: each.sampler for i, each in animations.items()})
    return {
        i: joints.placement(i, frame).apply(each.positions(frame)) for i, each in animations.items()
    }


@pytest.mark.parametrize("name", SAMPLES)
def test_window_shows_the_frames_of_an_export(name, tmp_path):
    document = load_project(sample_images() / f"{name}.lissom")
    first = document.layers[0]
    picture = decode_picture(first.picture.data, first.name).rgba
    session = session_of(document, tmp_path, picture, prepares_ahead=True)
    frames, size = document.frames, max(document.canvas)
    runtimes = session.project.runtimes.layers
    meshes = {i: runtime.store.mesh for i, runtime in runtimes.items()}
    for share in SHARES:
        frame = round(frames.first + share * (frames.last - frames.first))
        go(session, frame)
        for i, wanted in exported(document, meshes, frame).items():
            shown = runtimes[i].shown
            assert shown.is_current
            assert shown.mesh is meshes[i]
            drawn = shown.placement.apply(shown.positions)
            assert np.abs(drawn - wanted).max() < NEAR * size / 1000, (i, frame)
