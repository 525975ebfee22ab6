"""Members of a deform group that lie on each other, drawn in one pass."""

from collections.abc import Iterator, Mapping, Sequence
from contextlib import ExitStack
from typing import Final, NamedTuple

from app.document import CompositeGroup
from app.render.gpu.mesh import PosedMesh
from app.render.gpu.programs import ShaderFiles
from app.render.scene import Painted

MOST: Final = 8  # members in a pass; OpenGL has at least 16 texture units
_MEMBERS: Final = {
    count: ShaderFiles(
        vertex=("mesh.vert", "placed.glsl"),
        fragment=("sample.glsl", "members.frag"),
        constants=(("MEMBERS", count),),
    )
    for count in range(2, MOST + 1)
}


class Member(NamedTuple):
    """A mesh over the members before it."""

    mesh: PosedMesh
    opacity: float  # with the members clipped to it
    is_clipped: bool = False  # to the last member that is not


def split_runs(parts: Sequence[Painted]) -> Iterator[Painted | list[Member]]:
    """Yield parts, and runs of at least two members with the same vertices, from back to front."""
    run: list[Member] = []
    behind: list[Painted] = []  # the parts of the run

    def ended() -> Iterator[Painted | list[Member]]:
        if len(run) > 1:
            yield list(run)
        else:
            yield from behind
        run.clear()
        behind.clear()

    for part in parts:
        found = _members_of(part)
        fits = found and (not run or found[0].mesh.has_vertices_of(run[0].mesh))
        if run and not (fits and len(run) + len(found) <= MOST):
            yield from ended()
        if found and len(found) <= MOST:
            run += found
            behind.append(part)
        else:
            yield part
    yield from ended()


def _members_of(part: Painted) -> list[Member]:
    """Return the members that a part consists of; none if it needs a pass of its own."""
    if isinstance(part, PosedMesh):
        return [Member(part, 1.0)]
    base, *others = part.parts
    is_plain = part.blend == "normal" and not (part.clipped or part.effects or part.is_pass_through)
    if not is_plain or isinstance(base, CompositeGroup):
        return []
    found = [Member(base, part.opacity)]
    for each in others:
        if not isinstance(each, CompositeGroup) or not each.clipped or len(each.parts) != 1:
            return []
        (mesh,) = each.parts
        is_plain = each.blend == "normal" and not (each.effects or each.is_pass_through)
        if isinstance(mesh, CompositeGroup) or not is_plain or not mesh.has_vertices_of(base):
            return []
        found.append(Member(mesh, each.opacity, is_clipped=True))
    return found


def draw_members(run: Sequence[Member], uniforms: Mapping[str, object]) -> None:
    """Draw members with the same vertices, with blending of premultiplied colours."""
    first = run[0].mesh
    own: dict[str, object] = {
        "windows": [each.mesh.window_in(first) for each in run],
        "opacities": [each.opacity for each in run],
        "clipped": [float(each.is_clipped) for each in run],
        **{f"member_{unit}": unit for unit in range(len(run))},
    }
    with ExitStack() as bound:
        for unit, each in enumerate(run):
            bound.enter_context(each.mesh.picture.bound(unit))
        first.draw(_MEMBERS[len(run)], {**uniforms, **own})
