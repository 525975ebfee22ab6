"""The window over documents with much of every kind."""

from copy import copy
from dataclasses import replace
from pathlib import Path

from app.document import (
    OPACITY,
    SWITCH,
    Document,
    FrameRange,
    Handle,
    Keyframe,
    SwitchGroup,
    Target,
    clip_of,
)
from app.document.settings import Marker
from app.editor import LayerRuntime
from app.editor.actions.project_files import files, saving
from app.storage import decode_picture, load_project, sample_images
from engine.deform import MOST_HANDLES
from engine.domain import MeshedDomain, mesh_inside
from tests.bench.stage.driver import Driver
from tests.bench.table import Table, row_of

LAYERS, TRIANGLES = 500, 500  # at most, and of each of them
SETTLING = 3  # frames until all panels are laid out


def table(stage: Driver, folder: Path, count: int, frames: int) -> Table:
    """Measure the interface's own part of a frame with few and many of what a document can hold."""
    path = sample_images() / "ring.lissom"
    rows = []
    for name, document in _documents(load_project(path), count).items():
        with stage.session.jobs.held():
            files.install_opened_file(stage.session, folder / path.name, _opened(document))
            for _ in range(SETTLING):
                stage.refresh()
            rows.append(row_of(name, [stage.frame().own for _ in range(frames)]))
            saving.set_project(stage.session, None)
            for kind in stage.session.jobs.kinds:
                stage.session.jobs.drop(kind)
    return Table(
        title="The interface's own part of a frame, with much in view and nothing prepared",
        rows=tuple(rows),
    )


def _documents(sample: Document, count: int) -> dict[str, Document]:
    """Return a sample as it is, and with many of each kind, by what they have."""
    document = replace(sample, frames=FrameRange(0, max(count, sample.frames.last)))
    layer = document.layers[0]
    bare = replace(layer, cycles=(), tracks=(), motions=())
    pose = layer.keys[0].pose
    layers, handles = min(count, LAYERS), min(count, MOST_HANDLES)
    keys = tuple(Keyframe(frame=at, pose=pose) for at in range(count))
    fades = tuple(OPACITY.key(at, 0.5) for at in range(count))
    turns = tuple(SWITCH.key(at, at % 2) for at in range(count))
    vertices = layer.domain.mesh.vertices.tolist()
    spread = [
        Handle(id=each, name=f"handle {each}", position=vertices[each % len(vertices)])
        for each in range(handles)
    ]
    targets = {each.id: Target(position=each.position) for each in spread}
    posed = replace(
        bare,
        handles=tuple(spread),
        next_handle=handles,
        keys=(Keyframe(frame=0, pose=replace(pose, targets=targets)),),
    )
    mesh = mesh_inside(layer.domain, triangles=TRIANGLES)
    small = replace(bare, domain=replace(layer.domain, mesh=mesh))
    copies = [
        replace(small, id=each, name=f"layer {each}", attachments=()) for each in range(layers)
    ]
    return {
        "as it is": document,
        f"{count:,} markers": replace(
            document, markers=tuple(Marker(frame=at, name=f"marker {at}") for at in range(count))
        ),
        f"{count:,} keys of poses": replace(
            document, layers=(replace(bare, keys=keys), *document.layers[1:])
        ),
        f"{count:,} keys of opacity": replace(
            document,
            layers=(replace(bare, channels={(OPACITY.name, None): fades}), *document.layers[1:]),
        ),
        f"{count:,} turns of a switch": replace(
            document,
            layers=tuple(copies[:2]),
            switch_groups=(SwitchGroup(name="mouth", members=(0, 1), keys=turns),),
        ),
        f"{handles:,} handles": replace(document, layers=(posed, *document.layers[1:])),
        f"{layers:,} layers": replace(document, layers=tuple(copies)),
    }


def _opened(document: Document) -> files.OpenedFile:
    """Return a document as files are opened; layers with the same domain share what is known."""
    made: dict[MeshedDomain, LayerRuntime] = {}
    for layer in document.layers:
        if layer.domain not in made:
            picture = decode_picture(layer.picture.data, layer.name)
            made[layer.domain] = LayerRuntime.of(clip_of(document, layer.id), picture)
    puppets = {layer.id: copy(made[layer.domain]) for layer in document.layers}
    return files.OpenedFile(document, puppets, ())
