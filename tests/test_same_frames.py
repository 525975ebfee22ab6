"""The window shows the frames that an export has, wherever both have the same triangles."""

import numpy as np
import pytest
from sessions import go, session_of

from app.document import clip_of
from app.motion import Animation, ParentTransforms
from app.storage import decode_picture, load_project
from app.storage.assets import sample_images

NEAR = 0.05  # thousandths of the drawing's longer side
OTHERS = sorted({path.stem for path in sample_images().glob("*.lissom")} - {"ring"})
SHARES = (0.0, 0.13, 0.4, 0.5, 0.77, 1.0)  # of the animation, at which frames are compared


def exported(document, points, frames):
    """Return where an export has points of each layer in the scene, by frame."""
    clips = [clip_of(document, layer.id) for layer in document.layers]
    animations = {clip.layer.id: Animation(clip, points=points[clip.layer.id]) for clip in clips}
    joints = ParentTransforms(document, {i: each.sampler for i, each in animations.items()})
    return {
        frame: {
            i: joints.placement(i, frame).apply(each.positions(frame))
            for i, each in animations.items()
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
    points = {i: mesh.domain.mesh.vertices for i, mesh in meshes.items()}
    for frame, wanted in exported(document, points, frames).items():
        go(session, frame)
        for i, runtime in runtimes.items():
            assert runtime.shown.is_current
            assert runtime.shown.mesh is meshes[i]
            drawn = runtime.shown.placement.apply(runtime.shown.positions)
            assert np.abs(drawn - wanted[i]).max() < NEAR * max(document.canvas) / 1000, (i, frame)
