"""The window over documents with many keys and markers."""

from dataclasses import replace
from pathlib import Path

from app.document import Document, FrameRange, Keyframe, clip_of
from app.document.settings import Marker
from app.editor import Puppet
from app.editor.actions import files, saving
from app.storage import decode_picture, load_project, sample_images
from tests.bench.stage.driver import Driver
from tests.bench.table import Table, row_of

SETTLING = 3  # frames until all panels are laid out


def table(stage: Driver, folder: Path, count: int, frames: int) -> Table:
    """Measure the interface's own part of a frame with few and many keys and markers."""
    path = sample_images() / "ring.lissom"
    document = load_project(path)
    document = replace(document, frames=FrameRange(0, max(count, document.frames.last)))
    figure = document.figures[0]
    keys = tuple(Keyframe(frame=at, pose=figure.keys[0].pose) for at in range(count))
    markers = tuple(Marker(frame=at, name=f"marker {at}") for at in range(count))
    figures = (replace(figure, keys=keys, cycles=(), tracks=(), motions=()), *document.figures[1:])
    documents = {
        "as it is": document,
        f"{count:,} markers": replace(document, markers=markers),
        f"{count:,} keys of poses": replace(document, figures=figures),
    }
    rows = []
    for name, each in documents.items():
        with stage.session.jobs.held():
            files.show(stage.session, folder / path.name, _opened(each))
            for _ in range(SETTLING):
                stage.refresh()
            rows.append(row_of(name, [stage.frame().own for _ in range(frames)]))
            saving.put_project(stage.session, None)
            for kind in stage.session.jobs.kinds:
                stage.session.jobs.drop(kind)
    return Table(
        title="The interface's own part of a frame, many keys in view, nothing prepared",
        rows=tuple(rows),
    )


def _opened(document: Document) -> files.Opened:
    puppets = {
        figure.id: Puppet.of(
            clip_of(document, figure.id), decode_picture(figure.picture.data, figure.name)
        )
        for figure in document.figures
    }
    return files.Opened(document, puppets, ())
