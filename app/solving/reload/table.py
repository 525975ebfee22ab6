"""The changes of a reload in words, one line a layer."""

from collections.abc import Iterator
from typing import NamedTuple

from app.solving.reload.plan import Change, LayerChange, ReloadPlan
from app.texts import _


class ReloadRow(NamedTuple):
    """A layer, what happened to it in the file, and details."""

    name: str
    change: Change
    details: str

    @property
    def label(self) -> str:
        return _(self.change.value)


def reload_rows(plan: ReloadPlan) -> tuple[ReloadRow, ...]:
    """Return a row for each layer, from the front."""
    return tuple(
        ReloadRow(each.name, each.change, "; ".join(_details(plan, each))) for each in plan.changes
    )


def reload_lines(plan: ReloadPlan) -> Iterator[str]:
    """Yield the rows as lines of text in columns."""
    rows = reload_rows(plan)
    widths = [max((len(text) for text in column), default=0) for column in _columns(rows)]
    for row in rows:
        line = f"{row.label:<{widths[0]}}  {row.name:<{widths[1]}}  {row.details}"
        yield line.rstrip()
    yield from scene_changes(plan)


def scene_changes(plan: ReloadPlan) -> Iterator[str]:
    """Yield the changes of groups and of the canvas."""
    for path, present in plan.groups.renamed.items():
        yield _("the group {path} is now {present}").format(path=path, present=present)
    by = plan.scene_shift
    if by:
        yield _("the canvas changed: the scene moves by {right:+.0f}, {up:+.0f} pixels").format(
            right=by.real, up=by.imag
        )


def _columns(rows: tuple[ReloadRow, ...]) -> tuple[list[str], list[str]]:
    return [row.label for row in rows], [row.name for row in rows]


def _details(plan: ReloadPlan, change: LayerChange) -> Iterator[str]:
    if change.shift:
        yield _("by {right:+.0f}, {up:+.0f} pixels").format(
            right=change.shift.real, up=change.shift.imag
        )
    if change.renamed:
        yield _("renamed to {name}").format(name=change.renamed)
    if change.regrouped is not None and change.regrouped not in plan.groups.renamed.values():
        yield (
            _("now in the group {group}").format(group=change.regrouped)
            if change.regrouped
            else _("now outside groups")
        )
    yield from _changed_settings(plan, change)
    if change.change is Change.GONE:
        is_switched = plan.document.switch_group_of(change.layer or 0) is not None
        yield _("stays in its switch") if is_switched else _("stays, hidden")


def _changed_settings(plan: ReloadPlan, change: LayerChange) -> Iterator[str]:
    origin = None if change.layer is None else plan.document.layer(change.layer).origin
    if origin is None or change.index < 0:
        return
    was, now = plan.before.layers[origin.index], plan.now.layers[change.index]
    if was.opacity != now.opacity:
        yield _("opacity {share:.0%}").format(share=now.opacity)
    if was.blend != now.blend:
        yield _("blend {mode}").format(mode=now.blend)
    if was.clipped != now.clipped:
        yield _("clipped") if now.clipped else _("not clipped")
    if was.hidden != now.hidden:
        yield _("hidden") if now.hidden else _("visible")
