"""Exports of meshes without rendering, computed a few steps at a time."""

from collections import Counter
from collections.abc import Generator, Iterator, Mapping
from concurrent.futures import ThreadPoolExecutor
from typing import Final

from app.document import (
    DRAW_ORDER,
    OPACITY,
    Document,
    Group,
    Layer,
    channels_of,
    describe_channel,
)
from app.errors import join_names
from app.export.morph_mesh import (
    DEFAULT_TOLERANCE,
    MOST_TARGETS,
    MorphMesh,
    MorphScene,
    build_morph_scene,
)
from app.export.plan import ExportPlan
from app.export.run import wait_some
from app.export.writers.table import SHAPE_WRITERS
from app.export_formats import EXPORT_FORMATS
from app.motion import Evaluator
from app.storage import Cancellation, write_atomically
from app.texts import _
from engine.arrays import Bytes

_BATCH: Final = 16  # steps between two checks for cancellation


class MeshExport:
    """An export of meshes.

    Parameters
    ----------
    document : Document
        With the reduced meshes.
    pictures : mapping of int to uint8, shape (h, w, 4)
        Decoded pictures by layer id.
    evaluator : Evaluator
        Of the document's frames.
    """

    def __init__(
        self,
        document: Document,
        pictures: Mapping[int, Bytes],
        evaluator: Evaluator,
        plan: ExportPlan,
    ) -> None:
        self._plan = plan
        self._work = build_morph_scene(document, pictures, evaluator, plan)
        self._share = 0.0
        self._document = document
        self._scene: MorphScene | None = None

    @property
    def meshes(self) -> tuple[MorphMesh, ...]:
        """The meshes of the layers; empty before the end."""
        return () if self._scene is None else self._scene.meshes

    def run(
        self, *, waits: bool = True, cancellation: Cancellation | None = None
    ) -> Generator[int]:
        """Run the plan, a part of it at each step.

        Closing the iterator, or an exception, ends the export without any file. The running job is
        not awaited, as it may take long.

        Yields
        ------
        int
            Finished work as a number of the plan's frames.

        Raises
        ------
        LissomError
            If the motion fails at some frame, or the file cannot be written.
        """
        cancellation = cancellation or Cancellation()
        total, worker = len(self._plan.times), ThreadPoolExecutor(1)
        try:
            while self._scene is None:
                batch = worker.submit(self._advance)
                yield from wait_some(batch, count=int(self._share * total), waits=waits)
                yield int(self._share * total)
            end = worker.submit(self._write, self._scene, cancellation)
            yield from wait_some(end, count=total, waits=waits)
        except BaseException:
            cancellation.cancel()
            raise
        finally:
            worker.shutdown(wait=False, cancel_futures=True)
        yield total

    @property
    def notices(self) -> tuple[str, ...]:
        wanted, format_ = self._plan.shapes.tolerance, EXPORT_FORMATS[self._plan.format]
        found = []
        for shape in self.meshes:
            count, error = len(shape.motion.targets), shape.motion.error
            if wanted is None and error > DEFAULT_TOLERANCE:
                found.append(
                    _(
                        "{name} has {count} shapes, within {error:.2g} pixels of the motion; a "
                        "custom tolerance uses as many as it needs"
                    ).format(count=count, error=error, name=shape.name)
                )
            elif count > MOST_TARGETS:
                found.append(
                    _(
                        "{name} has {count} shapes, but viewers of glTF need not show more than "
                        "{most}; a larger tolerance needs fewer shapes"
                    ).format(name=shape.name, count=count, most=MOST_TARGETS)
                )
            if len(shape.triangle_orders) > 1 and not format_.keeps_order:
                found.append(
                    _(
                        "the parts of {name} change their depth, but the {format} keeps the "
                        "order of the first frame"
                    ).format(name=shape.name, format=format_.label)
                )
        layers = self._document.exported_layers
        constant = [
            describe_channel(self._document, channel)
            for each in layers
            for channel in channels_of(each)
            if channel.kind in (OPACITY, DRAW_ORDER) or channel.kind.uniform
        ]
        constant += [_("the camera")] if self._document.camera and not format_.has_frame else []
        if constant:
            found.append(
                _("the {format} does not animate {channels}").format(
                    format=format_.label, channels=", ".join(constant)
                )
            )
        shared = Counter(id(shape.motion) for shape in self.meshes)
        members = [shape.name for shape in self.meshes if shared[id(shape.motion)] > 1]
        if members:
            found.append(
                _(
                    "the {format} paints {names} one after the other, so where their mesh covers "
                    "itself, the covered part shows through"
                ).format(names=join_names(members), format=format_.label)
            )
        moving = [each.name for each in layers if each.footage is not None]
        if moving:
            found.append(
                _(
                    "the {format} does not contain footage; it shows the first picture of {names}"
                ).format(format=format_.label, names=join_names(moving))
            )
        return (*found, *(() if format_.composites else self._uncomposited(format_.label)))

    def _uncomposited(self, label: str) -> Iterator[str]:
        """Yield notices about blends that a format without compositing cannot show."""
        groups = self._document.groups
        painted: list[Layer | Group] = [*self._document.exported_layers, *groups]
        not_blended = _("the {format} cannot blend {names}; they are painted over the rest")
        not_clipped = _("the {format} cannot clip {names}; they are painted over the rest")
        for notice, names in (
            (
                not_blended,
                [each.name for each in painted if each.blend not in {"normal", "pass-through"}],
            ),
            (not_clipped, [each.name for each in painted if each.clipped]),
        ):
            if names:
                yield notice.format(names=", ".join(names), format=label)
        faint = [group.name for group in groups if group.opacity < 1]
        if faint:
            yield _(
                "in the {format} the layers of {names} fade one by one, and shine through each "
                "other"
            ).format(names=", ".join(faint), format=label)

    def _write(self, scene: MorphScene, cancellation: Cancellation) -> None:
        contents = SHAPE_WRITERS[self._plan.format](scene, self._plan)
        write_atomically(self._plan.out, lambda file: file.write(contents), cancellation)

    def _advance(self) -> None:
        for _step in range(_BATCH):
            try:
                self._share = next(self._work)
            except StopIteration as stop:
                self._scene = stop.value
                return
