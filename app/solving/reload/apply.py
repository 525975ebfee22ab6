"""The document after a reload: the same handles, keys and joints on the changed artwork."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace

from app.document import Command, Document, Layer, PictureFile, layer_commands
from app.errors import join_names
from app.solving.deform_group.rebuilding import RebuiltGroup, rebuild_group
from app.solving.reload.file_groups import document_paths, update_groups
from app.solving.reload.file_settings import (
    close_seam_again,
    with_file_order,
    with_file_settings,
    with_new_layers,
    with_new_origins,
    with_reloaded_layers,
)
from app.solving.reload.pictures import PlacedMask, move_cut_out
from app.solving.reload.plan import Change, LayerChange, ReloadPlan
from app.solving.reload.replace_picture import (
    distance_notices,
    start_picture_replacement,
)
from app.solving.reload.shifting import shift_layer, shift_scene, with_moved_joints
from app.solving.resolve_keys import KeyResolver, step_resolver
from app.storage import (
    ImportedLayer,
    Picture,
    cut_picture,
    make_posable_layer,
    make_still_picture,
    run_parallel,
)
from app.texts import _, message_of


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class Reloading:
    """A reload in progress: layers with another shape, whose keys are solved one by one."""

    plan: ReloadPlan
    resolvers: tuple[KeyResolver, ...] = ()
    layers: Mapping[int, Layer] = field(default_factory=dict)  # finished, by id
    new: tuple[tuple[LayerChange, Layer], ...] = ()
    group_pictures: Mapping[int, Picture] = field(default_factory=dict)  # of deform groups, by id
    notices: tuple[str, ...] = ()

    @property
    def is_over(self) -> bool:
        return all(resolver.is_over for resolver in self.resolvers)

    @property
    def progress(self) -> float:
        """The finished share of the keys, 0 to 1."""
        count = sum(len(each.before.poses) for each in self.resolvers)
        return sum(len(each.poses) for each in self.resolvers) / max(count, 1)

    @property
    def pictures(self) -> dict[PictureFile, Picture]:
        """The decoded pictures of changed and new layers."""
        by_layer = {change.layer: change.imported for change in self.plan.changes}
        changed = [
            (layer.picture, by_layer[identity])
            for identity, layer in self.finished.items()
            if identity in by_layer
        ]
        changed += [(layer.picture, change.imported) for change, layer in self.new]
        bent = {
            layer.picture: self.group_pictures[identity]
            for identity, layer in self.finished.items()
            if identity in self.group_pictures
        }
        return bent | {
            file: imported.picture
            for file, imported in changed
            if imported is not None and file.data is imported.data
        }

    @property
    def finished(self) -> dict[int, Layer]:
        """All changed layers, by id."""
        solved = {
            each.before.id: each.new_layer.with_poses(each.poses)
            for each in self.resolvers
            if each.new_layer is not None and each.is_over
        }
        return {**self.layers, **solved}

    @property
    def command(self) -> Command:
        """The command that applies everything as one undo step."""
        return Command(_("Reload drawing"), lambda _: _reloaded(self))

    @property
    def all_notices(self) -> tuple[str, ...]:
        """Notices about handles, joints and poses, once everything is solved."""
        unsolved = [
            _("{layer} {poses}").format(layer=each.before.name, poses=", ".join(each.unsolved))
            for each in self.resolvers
            if each.unsolved
        ]
        notices = [*self.notices]
        if unsolved:
            notices.append(
                _("poses that exceed the limits: {poses}").format(poses="; ".join(unsolved))
            )
        return (*notices, *_switch_notices(self.plan))


def start_reload(plan: ReloadPlan) -> Reloading:
    """Find the shapes of redrawn and new layers; nothing is solved yet."""
    shifted = replace(plan, document=shift_scene(plan.document, plan.scene_shift))
    shifted = replace(
        shifted, changes=tuple(close_seam_again(shifted, each) for each in plan.changes)
    )
    changes = [each for each in shifted.changes if each.change not in {Change.SAME, Change.GONE}]
    made = run_parallel(
        lambda change: _made(shifted, change),
        changes,
        (each.imported.picture.size for each in changes if each.imported is not None),
    )
    bent = _rebuilt_groups(shifted, made)
    there: list[_Made | RebuiltGroup] = [each for each in made if not each.is_new]
    there += bent.values()
    layers = {each.layer.id: each.layer for each in there if each.layer}
    return Reloading(
        plan=shifted,
        resolvers=tuple(each.resolver for each in there if each.resolver is not None),
        layers=layers,
        new=tuple((each.change, each.layer) for each in made if each.layer and each.is_new),
        group_pictures={identity: each.picture for identity, each in bent.items()},
        notices=(
            *(notice for each in made for notice in each.notices),
            *(notice for each in bent.values() for notice in each.notices),
        ),
    )


def _rebuilt_groups(plan: ReloadPlan, made: Sequence["_Made"]) -> dict[int, RebuiltGroup]:
    """Return the deform groups of changed members, by id."""
    document, found = plan.document, {}
    now = {
        each.change.layer: each.layer or (each.resolver and each.resolver.new_layer)
        for each in made
        if each.layer or each.resolver
    }
    pictures = dict(plan.pictures)
    for each in plan.changes:
        is_redrawn = each.change is not Change.MOVED and each.layer in now
        if is_redrawn and each.layer is not None and each.imported is not None:
            pictures[each.layer] = each.imported.picture
    shifts = {each.layer: each.shift for each in plan.changes}
    for group in document.layers:
        members = document.deform_members(group.id)
        if not any(member.id in now for member in members):
            continue
        moved = {shifts.get(member.id, 0j) for member in members}
        by = moved.pop() if len(moved) == 1 else 0j
        present = [now.get(member.id) or member for member in members]
        found[group.id] = rebuild_group(group, present, plan.pictures, pictures, by)
    return found


def step_reload(reloading: Reloading) -> Reloading:
    """Solve the next key of each layer with another shape."""
    resolvers = run_parallel(
        lambda each: each if each.is_over else step_resolver(each),
        reloading.resolvers,
        (),
    )
    return replace(reloading, resolvers=tuple(resolvers))


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class _Made:
    """A changed or new layer: finished, or with keys to solve."""

    change: LayerChange
    layer: Layer | None = None
    resolver: KeyResolver | None = None
    notices: tuple[str, ...] = ()

    @property
    def is_new(self) -> bool:
        return self.change.change is Change.NEW


def _made(plan: ReloadPlan, change: LayerChange) -> _Made:
    imported = change.imported
    if imported is None:
        return _Made(change=change)
    if change.layer is None:
        placed = replace(imported, corner=change.corner)
        meshing = plan.document.layers[-1].meshing
        layer, notices = make_posable_layer(placed, 0, meshing, is_cut_out=True)
        return _Made(change=change, layer=layer, notices=_named(imported.name, notices))
    before = plan.document.layer(change.layer)
    if change.change is Change.MOVED:
        return _Made(change=change, layer=shift_layer(before, change.shift))
    return _redrawn(before, change, imported, plan.pictures[before.id])


def _named(name: str, notices: tuple[str, ...]) -> tuple[str, ...]:
    return tuple(f"{name}: {notice}" for notice in notices)


def _redrawn(before: Layer, change: LayerChange, imported: ImportedLayer, old: Picture) -> _Made:
    """Return a redrawn layer. With an equal mask only its picture changes."""
    picture, corner, by = imported.picture, change.corner, change.shift
    cut_out = move_cut_out(before.cut_out, before.corner + by - corner, picture.size)
    notices: tuple[str, ...] = ()
    if before.still:
        made = make_still_picture(imported.data, picture)
        if before.deform_group is not None:
            made = replace(made, cut_out=cut_out)
    else:
        was = cut_picture(old, before.cut_out, is_alone=False)
        now = cut_picture(picture, cut_out, is_alone=False)
        moved = shift_layer(before, by)
        is_same = PlacedMask.of(was.kept, moved.corner) == PlacedMask.of(now.kept, corner)
        if is_same and not before.is_stale:
            file = PictureFile(data=imported.data, suffix=picture.suffix, size=picture.size)
            same = replace(moved, picture=file, corner=corner, cut_out=cut_out)
            return _Made(change=change, layer=same)
        made, notices = make_posable_layer(
            replace(imported, corner=0j), before.id, before.meshing, cut_out, is_cut_out=False
        )
        if made.still:
            text = _("kept as it was, because its new picture cannot be posed: {reason}")
            reason = "; ".join(map(message_of, notices))
            return _Made(change=change, notices=_named(before.name, (text.format(reason=reason),)))
    resolver = start_picture_replacement(before, made, corner, by)
    return _Made(
        change=change,
        resolver=resolver,
        notices=_named(before.name, (*notices, *distance_notices(resolver))),
    )


def _reloaded(reloading: Reloading) -> Document:
    """Return the document with all changes: pictures, settings, groups, order and joints."""
    plan, after = reloading.plan, reloading.finished
    document = plan.document
    is_own_canvas = plan.before.size == document.canvas and not plan.before.corner
    size = plan.now.size if plan.is_whole and is_own_canvas else document.canvas
    shifts = {each.layer: each.shift for each in plan.changes if each.layer is not None}
    there = {layer.id: after.get(layer.id, layer) for layer in document.layers}
    layers = tuple(with_moved_joints(layer, shifts, there) for layer in there.values())
    document = replace(document, layers=layers, size=size)
    groups = plan.groups
    if plan.is_whole:
        document = update_groups(document, groups)
    paths = document_paths(document, plan.before)
    for change in plan.changes:
        document = with_file_settings(document, plan, groups, paths, change)
    if plan.is_whole:
        document = with_new_origins(with_file_order(document, plan), plan)
        document = with_new_layers(document, plan, groups, paths, reloading.new)
    else:
        document = with_reloaded_layers(document, plan)
    for identity in after:
        document = layer_commands.keep_attachments(identity)(document)
    return layer_commands.without_empty_groups(document)


def _switch_notices(plan: ReloadPlan) -> tuple[str, ...]:
    """Return notices about layers that are gone from the file, and that a switch still shows."""
    text = _("the switch {switch} still shows {layers}, which the file does not have any more")
    return tuple(
        text.format(switch=switch.name, layers=join_names(names))
        for switch in plan.document.switch_groups
        if (
            names := [
                each.name
                for each in plan.changes
                if each.change is Change.GONE and each.layer in switch.members
            ]
        )
    )
