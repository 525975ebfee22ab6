"""The pictures and meshes of a project's layers on the graphics card."""

from collections.abc import Callable, Collection

import numpy as np

from app.document import Layer, stiffness_source
from app.editor import HeatMap, Project
from app.motion import DeformMesh, LayerFrame, Vertices
from app.render import DrawnMesh, MemberMesh, Renderer, shader_is_faster
from app.render.gpu.mesh import GpuMesh, PosedMesh
from app.render.gpu.picture import GpuPicture
from app.storage import Picture, release_pages
from app.ui.viewport.backdrop import measure_edge
from app.ui.viewport.cutout_overlay import CutView
from app.ui.viewport.stiffness_overlay import measure_vertex_stiffness
from engine.arrays import Bytes, Floats
from engine.maps import distortion


def measure_distortion(shown: LayerFrame, heat_map: HeatMap) -> Floats:
    """Return a distortion measure at the vertices of the shown frame, (v,)."""
    fz, fzbar = shown.derivatives
    match heat_map:
        case "sigma_a":
            return distortion.sigma_a(fz, fzbar)
        case "sigma_b":
            return distortion.sigma_b(fz, fzbar)
        case _:
            return distortion.k(fz, fzbar)


class GpuResources:
    """Owner of the pictures and meshes of a project's layers on the graphics card."""

    def __init__(self, renderer: Renderer, project: Project) -> None:
        self.project = project
        self._renderer = renderer
        # By layer id and picture: a layer's picture may be replaced, and ids are reused after a
        # layer is deleted. Layers without a cut-out share a picture under the id None.
        self._pictures: dict[tuple[int | None, Picture], GpuPicture] = {}
        self._meshes: dict[tuple[DeformMesh, int], GpuMesh] = {}  # by mesh and layer
        # By mesh, number and layer. Members of a deform group follow the first one drawn.
        self._drawn_meshes: dict[tuple[DeformMesh, int, int], DrawnMesh | MemberMesh] = {}
        self._leaders: dict[tuple[DeformMesh, int], DrawnMesh] = {}
        self._ghosts: dict[tuple[int, int], tuple[object, Vertices]] = {}
        self._heated: dict[PosedMesh, tuple[Vertices, HeatMap]] = {}
        self._cut_view: CutView | None = None
        self._measured: tuple[Bytes, Floats] | None = None
        self._stiff: tuple[Layer, DeformMesh, Floats] | None = None

    @property
    def edge(self) -> Floats:
        """Brightness along the edge of the backmost picture. The backdrop must differ from it."""
        (first, *_) = self.project.document.layers
        texture = self.project.runtimes.layers[first.id].cut.value.texture
        if self._measured is None or self._measured[0] is not texture:
            self._measured = texture, measure_edge(texture)
        return self._measured[1]

    def drawn_mesh(self, layer: int, mesh: DeformMesh, number: int = 0) -> DrawnMesh | MemberMesh:
        """Return the copy of a layer's mesh with this number. Each copy has its own pose."""
        known = self._meshes.get((mesh, layer))
        if known is not None and known.picture is not self.picture(layer):
            # The cut-out status of the picture may have changed.
            self.release_but({each for each, _layer in self._meshes} - {mesh})
        if (mesh, number, layer) not in self._drawn_meshes:
            leader, gpu_mesh = self._leaders.get((mesh, number)), self._mesh(layer, mesh)
            if leader is None:
                by_shader = shader_is_faster(self._renderer.programs.context)
                drawn = self._leaders[mesh, number] = DrawnMesh(gpu_mesh, by_shader=by_shader)
                self._drawn_meshes[mesh, number, layer] = drawn
            else:
                self._drawn_meshes[mesh, number, layer] = MemberMesh(gpu_mesh, leader)
        return self._drawn_meshes[mesh, number, layer]

    def ghost(
        self, layer: int, number: int, of: object, find: Callable[[], Vertices | None]
    ) -> Vertices | None:
        """Return a layer's vertices in a copy that shows another frame, if known.

        They are computed again only if `of` has changed, because the picture changes every frame.
        """
        known = self._ghosts.get((layer, number))
        if known is None or known[0] != of:
            vertices = find()
            if vertices is None:
                return None
            known = self._ghosts[layer, number] = of, vertices
        return known[1]

    def heat(self, pose: PosedMesh, shown: LayerFrame, heat_map: HeatMap) -> None:
        """Colour a pose by the distortion of the shown frame. Uploads only if it has changed."""
        wanted = (shown.vertices, heat_map)
        if self._heated.get(pose) != wanted:
            pose.write_heat(measure_distortion(shown, heat_map).astype(np.float32))
            self._heated[pose] = wanted

    def refresh(self) -> None:
        """Update the pictures to their present cut-outs, and to the shown frame of footage."""
        used = {self._key(layer): layer for layer in self.project.runtimes.layers}
        for key in list(self._pictures):
            if key in used:
                self._pictures[key].write(self._pixels(used[key]))
            else:
                # Undo may bring it back, but its mesh is gone.
                self._pictures.pop(key).release()

    def tint(self, pose: PosedMesh, values: Floats) -> None:
        """Colour a pose by values of its vertices, (v,), other than a distortion."""
        pose.write_heat(values.astype(np.float32))
        self._heated.pop(pose, None)

    def stiffness(self, layer: Layer, mesh: DeformMesh) -> Floats:
        """Return the stiffness colours of a layer's vertices, (v,).

        They are computed again only if the stiffness has changed, because the picture changes every
        frame.
        """
        known = self._stiff
        if (
            known is None
            or known[1] is not mesh
            or known[0].domain is not layer.domain
            or stiffness_source(known[0]) != stiffness_source(layer)
        ):
            known = self._stiff = layer, mesh, measure_vertex_stiffness(layer, mesh)
        return known[2]

    def release_but(self, meshes: Collection[DeformMesh]) -> None:
        # Members after their leader come first.
        for key in [key for key in reversed(self._drawn_meshes) if key[0] not in meshes]:
            self._drawn_meshes.pop(key).release()
            self._leaders.pop(key[:2], None)
            self._heated.clear()
            self._ghosts.clear()
        for known in [known for known in self._meshes if known[0] not in meshes]:
            self._meshes.pop(known).release()

    def cut_view(self) -> CutView:
        """Return the view of the active layer while it is cut out."""
        if self._cut_view is None or self._cut_view.runtime is not self.project.layer_runtime:
            self._forget_cut_view()
            self._cut_view = CutView(self._renderer, self.project, self.project.selection.active)
        return self._cut_view

    def _forget_cut_view(self) -> None:
        if self._cut_view is not None:
            self._cut_view.release()
            self._cut_view = None

    def release(self) -> None:
        self._forget_cut_view()
        self.release_but(())
        for picture in self._pictures.values():
            picture.release()

    def _mesh(self, layer: int, mesh: DeformMesh) -> GpuMesh:
        if (mesh, layer) not in self._meshes:
            drawn, shown = mesh.domain.mesh, self.project.document.layer(layer)
            bent = self.project.document.deform_layer(shown)
            self._meshes[mesh, layer] = GpuMesh(
                self._renderer.programs,
                self.picture(layer),
                rest=drawn.vertices - shown.corner,
                triangles=drawn.triangles,
                seam=mesh.closed_cuts(bent),
            )
        return self._meshes[mesh, layer]

    @property
    def picture_count(self) -> int:
        return len(self._pictures)

    def picture(self, layer: int) -> GpuPicture:
        """Return a layer's picture on the graphics card. Uncut layers of one file share it."""
        key = self._key(layer)
        if key not in self._pictures:
            texture = self.project.runtimes.layers[layer].cut.value.texture
            context = self._renderer.programs.context
            self._pictures[key] = GpuPicture(context, texture, is_for_screen=True)
            self._pictures[key].write(self._pixels(layer))
            release_pages(texture)
        return self._pictures[key]

    def _pixels(self, layer: int) -> Bytes:
        """Return the shown frame of a layer's footage, or else its picture as it is cut out."""
        moving = self.project.footage_picture(self.project.document.layer(layer))
        still = self.project.runtimes.layers[layer].cut.value.texture
        return still if moving is None else moving

    def _key(self, layer: int) -> tuple[int | None, Picture]:
        runtime = self.project.runtimes.layers[layer]
        is_whole = runtime.cut.value.texture is runtime.picture.rgba
        is_whole &= self.project.document.layer(layer).footage is None
        return None if is_whole else layer, runtime.picture
