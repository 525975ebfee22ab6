"""The limits of a layer's poses: presets, and the values of each limit."""

from dataclasses import dataclass, replace

from imgui_bundle import imgui

from app.document import LIMIT_PRESETS, find_limit_preset, segment_keys, segment_time_at
from app.editor import Action, Project, do
from app.editor.actions.layer_setup import resolving
from app.texts import _
from app.ui.style.sliders import FIELD, Scale, number_field, slider_track
from app.ui.style.theme import Look
from app.ui.style.widgets import (
    FILL,
    align_right,
    draw_tooltip,
    heading,
    option_buttons,
    small_text,
)
from engine.maps import Bounds, Certificate

_DETAILS = imgui.TreeNodeFlags_.no_tree_push_on_open | imgui.TreeNodeFlags_.frame_padding
NEAR = 0.85  # share of a limit above which its bar warns


@dataclass(frozen=True, slots=True)
class LimitRow:
    """A limit: its field in `Bounds` and `Certificate`, and its labels."""

    field: str
    name: str
    symbol: str
    hint: str
    scale: Scale
    unit: str = ""


# From no distortion at the left to nearly no limit at the right.
LIMITS = (
    LimitRow(
        "k",
        _("Shear"),
        "k",
        _("How far angles change: 0 not at all, 1 collapses the shape"),
        Scale(left=0.0, right=0.98),
    ),
    LimitRow(
        "sigma_a",
        _("Stretch"),
        "σa",
        _("The largest stretch in any direction"),
        Scale(left=1.0, right=20.0, logarithmic=True),
        " ×",
    ),
    LimitRow(
        "sigma_b",
        _("Squeeze"),
        "σb",
        _("The smallest stretch in any direction"),
        Scale(left=1.0, right=0.05, logarithmic=True),
        " ×",
    ),
)
LEAST = {"k": 0.05, "sigma_a": 1.05, "sigma_b": 0.95}  # the tightest limits on the sliders


def draw_limits(look: Look, project: Project) -> list[Action]:
    """Draw the presets and, folded, each limit with the distortion of the pose."""
    bounds = _wanted_bounds(project)
    actions = _stretch(look, bounds)
    if imgui.tree_node_ex(_("Details"), _DETAILS):
        reached = _reached(project)
        small_text(
            look,
            _("Poses never exceed these limits. Bars: what this pose uses.")
            if _is_pose(project)
            else _("Poses never exceed these limits. Bars: what the keys before and after use."),
        )
        for limit in LIMITS:
            actions += _limit(look, limit, bounds, reached)
    return actions


def _wanted_bounds(project: Project) -> Bounds:
    if project.layer_setup.previewed_limits is not None:
        return project.layer_setup.previewed_limits
    return project.layer.bounds if project.key_resolver is None else project.key_resolver.bounds


def _reached(project: Project) -> tuple[Certificate, ...]:
    """Return the certificates of the shown pose, or of the two keys around an in-between."""
    shown, clip = project.layer_runtime.shown, project.clip
    if shown is not None and shown.pose is not None:
        return (shown.pose.certificate,)
    pair = segment_keys(clip)[segment_time_at(clip, shown.frame if shown else 0).segment]
    return tuple(clip.keys[index].pose.certificate for index in pair)


def _is_pose(project: Project) -> bool:
    """Return whether a pose is shown, and not an in-between."""
    shown = project.layer_runtime.shown
    return shown is not None and shown.pose is not None


def _stretch(look: Look, bounds: Bounds) -> list[Action]:
    """Draw the presets for all three limits, and the hint of the chosen preset."""
    heading(look, _("Stretch"))
    present = find_limit_preset(bounds)
    words = [(stretch.name, _(stretch.name)) for stretch in LIMIT_PRESETS]
    chosen = option_buttons(look, "stretch", words, present.name if present else "")
    hint = (
        _("{hint}.").format(hint=_(present.hint))
        if present
        else _("Custom limits, set under Details.")
    )
    small_text(look, hint)
    return [do(resolving.set_limits, s.bounds) for s in LIMIT_PRESETS if s.name == chosen]


def _limit(
    look: Look, limit: LimitRow, bounds: Bounds, reached: tuple[Certificate, ...]
) -> list[Action]:
    """Draw a limit: its name and value on one line, below them a bar that the limit ends."""
    palette = look.palette
    bound = float(getattr(bounds, limit.field))
    used = max((float(getattr(c, limit.field)) for c in reached), key=limit.scale.share)
    imgui.align_text_to_frame_padding()
    imgui.text_unformatted(limit.name)
    imgui.same_line(0, 0.35 * look.em)
    imgui.text_colored(palette.dim, limit.symbol)
    draw_tooltip(limit.hint)
    text = _("{used:.2f}{unit}  of").format(used=used, unit=limit.unit)
    room = FIELD * look.em + imgui.get_style().item_inner_spacing.x
    align_right(room + imgui.calc_text_size(text).x)
    colour = _colour(look, limit, used, bound)
    imgui.text_colored(colour, text)
    imgui.same_line(0, imgui.get_style().item_inner_spacing.x)
    imgui.set_next_item_width(FILL)
    entered = number_field(f"bound {limit.field}", bound)
    draw_tooltip(_("{hint}: type its limit").format(hint=limit.hint))
    imgui.set_cursor_pos_y(imgui.get_cursor_pos_y() - 0.5 * imgui.get_style().item_spacing.y)
    moved = slider_track(
        look,
        f"bound {limit.field} track",
        bound,
        limit.scale,
        imgui.get_content_region_avail().x,
        colour=colour,
        used=used,
    )
    draw_tooltip(_("{hint}: drag its limit").format(hint=limit.hint))
    imgui.set_cursor_pos_y(imgui.get_cursor_pos_y() - 0.5 * imgui.get_style().item_spacing.y)
    if entered is not None:
        return [do(resolving.set_limit, bounds, limit.field, entered)]
    if moved is None:
        return []
    strictest, widest = LEAST[limit.field], limit.scale.right
    value = min(max(moved.value, min(strictest, widest)), max(strictest, widest))
    wanted = replace(bounds, **{limit.field: round(value, 2)})
    return [do(resolving.set_limits if moved.is_final else resolving.preview_limits, wanted)]


def _colour(look: Look, limit: LimitRow, used: float, bound: float) -> imgui.ImVec4:
    palette, scale = look.palette, limit.scale
    share = scale.share(used) / max(scale.share(bound), 1e-6)
    return palette.danger if share > 1.0 else palette.warning if share > NEAR else palette.good
