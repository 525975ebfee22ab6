"""The bar of the cut-out: by colour, brush, knife and mask; and its holes."""

from imgui_bundle import ImVec2, icons_fontawesome_6 as icons, imgui

from app.cut_out import CutOut
from app.editor import Action, CutTool, Project, Session, do
from app.editor.actions.layer_setup import cut_out_editing, resolving
from app.editor.tools import move_tool
from app.texts import _, ngettext
from app.ui.shortcuts.keys import shown_keys
from app.ui.style.sliders import Scale, slider, slider_track
from app.ui.style.theme import Look
from app.ui.style.widgets import (
    FILL,
    align_right,
    draw_tooltip,
    heading,
    icon_button,
    label,
    main_button,
    option_buttons,
    progress_bar,
    small_text,
    split_line,
    text_button,
)

WIDE, SIZE = 36.0, 7.0  # em: least room for the names of tools, width of the size
TOLERANCES = Scale(left=0, right=120)
BRUSHES = Scale(
    left=cut_out_editing.SMALLEST_BRUSH, right=cut_out_editing.LARGEST_BRUSH / 2, logarithmic=True
)
BACKGROUNDS = (("auto", _("Auto")), ("none", _("None")), ("colour", _("Colour")))
ENCLOSED = (("auto", _("Auto")), ("keep", _("Keep")), ("remove", _("Remove")))
HAND_TOOLS: tuple[tuple[CutTool, str, str, str], ...] = (
    (
        "keep",
        icons.ICON_FA_PAINTBRUSH,
        _("Keep"),
        _("Brush over the parts that belong to the drawing"),
    ),
    ("remove", icons.ICON_FA_ERASER, _("Remove"), _("Brush over the parts to remove")),
    (
        "knife",
        icons.ICON_FA_SCISSORS,
        _("Knife"),
        _("Separate parts that touch: draw a line between them, from outside inwards"),
    ),
)


def draw_cut_out_bar(
    session: Session, look: Look, project: Project, room: float
) -> tuple[list[Action], bool]:
    """Draw the tools that cut by hand in `room` pixels. Also return whether settings are open."""
    actions: list[Action] = []
    with_names = room > WIDE * look.em
    for tool, icon, name, hint in HAND_TOOLS:
        text = f"{icon}  {name}" if with_names else icon
        actions += _tool(session, look, tool, text, hint if with_names else f"{name}: {hint}")
        imgui.same_line()
    radius, width = cut_out_editing.brush_radius(project), SIZE * look.em
    moved = slider_track(look, "brush", radius, BRUSHES, width, colour=look.palette.accent)
    draw_tooltip(brush_hint())
    if moved is not None:
        actions.append(do(cut_out_editing.set_brush_radius, moved.value))
    imgui.same_line()
    opened, storage = imgui.get_id("settings are open"), imgui.get_state_storage()
    is_open = storage.get_bool(opened)
    hint = _("Background, mask and holes")
    if icon_button(look, icons.ICON_FA_SLIDERS, "cut-out settings", hint, active=is_open):
        storage.set_bool(opened, not is_open)
    imgui.same_line()
    if main_button(
        look,
        _("Done") + "###done",
        hint=_("Show the posed drawing"),
        keys=shown_keys(move_tool.return_to_posing),
    ):
        actions.append(do(cut_out_editing.toggle_cut_tool, None))
    return actions + _state(look, project), is_open


def draw_cut_out_settings(session: Session, look: Look, project: Project) -> list[Action]:
    cut_out = project.layer.cut_out
    heading(look, _("Background"))
    actions = _background(session, look, project, cut_out)
    heading(look, _("Strokes and mask"), framed=True)
    align_right(1.15 * imgui.get_frame_height())
    if icon_button(
        look,
        icons.ICON_FA_TRASH,
        "forget strokes",
        _("Delete all strokes, all knife lines and the mask"),
        reason=None if cut_out.is_by_hand else _("There is nothing to delete."),
    ):
        actions.append(do(cut_out_editing.clear_cut_out_strokes))
    actions += _mask(look, cut_out)
    heading(look, _("Holes"))
    return actions + _holes(session, look, project)


def _background(session: Session, look: Look, project: Project, cut_out: CutOut) -> list[Action]:
    if not project.layer_runtime.is_opaque and cut_out.background == "auto":
        small_text(look, _("The picture is already transparent around the drawing."))
    elif project.layer_runtime.is_opaque and project.layer_runtime.cut.value.is_all:
        small_text(
            look,
            _(
                "The whole picture is the drawing. Pick the background's colour, or brush the "
                "rest away."
            ),
        )
    actions: list[Action] = []
    imgui.begin_disabled(cut_out.mask is not None)
    label(look, _("Remove"))
    kind = "colour" if isinstance(cut_out.background, tuple) else cut_out.background
    match option_buttons(look, "background", BACKGROUNDS, kind):
        case "auto" | "none" as chosen:
            actions.append(do(cut_out_editing.set_background, chosen))
        case "colour":
            actions.append(do(cut_out_editing.toggle_cut_tool, "pick"))
    draw_tooltip(
        _(
            "Lissom removes a plain background: the colour at the picture's border, or the "
            "colour that you pick"
        )
    )
    imgui.end_disabled()
    label(look, _("Colour"))
    text = f"{icons.ICON_FA_EYE_DROPPER}  {_('Pick')}"
    actions += _tool(session, look, "pick", text, _("Click on the background in the picture"))
    if isinstance(cut_out.background, tuple):
        red, green, blue = (level / 255 for level in cut_out.background)
        imgui.same_line()
        imgui.color_button("##background", (red, green, blue, 1.0))
    label(look, _("Tolerance"))
    hint = _("How far the background may vary in colour, 0 to 255")
    entered = slider(look, "tolerance", cut_out.tolerance, TOLERANCES, text="%.0f", hint=hint)
    if entered is not None:
        actions.append(do(cut_out_editing.set_background_tolerance, round(entered.value)))
    label(look, _("Inside"))
    enclosed = option_buttons(look, "enclosed", ENCLOSED, cut_out.enclosed)
    if enclosed is not None:
        actions.append(do(cut_out_editing.set_enclosed_removed, enclosed))
    draw_tooltip(
        _(
            "Parts inside that have the background's colour, as between an arm and the body. "
            "Auto removes vivid colours, but keeps white, grey and black, which eyes have "
            "too. Use “Click holes” to change a single part."
        )
    )
    if project.layer_runtime.cut.value.background_like is not None:
        small_text(
            look,
            _(
                "Parts inside have the background's colour and stay. They are tinted blue while a "
                "tool is active."
            ),
        )
    if cut_out.mask is not None:
        small_text(look, _("A mask was loaded. It replaces these settings."))
    return actions


def brush_hint() -> str:
    """Return the tooltip of the brush's size, with the shortcuts that change the size."""
    smaller, larger = map(shown_keys, (cut_out_editing.shrink_brush, cut_out_editing.enlarge_brush))
    text = _("Radius of the brush in pixels of the picture. {smaller} and {larger} change it.")
    return text.format(smaller=smaller, larger=larger)


def _mask(look: Look, cut_out: CutOut) -> list[Action]:
    actions: list[Action] = []
    widths = split_line(2)
    hint = _("Load a black and white picture of the same size: white is kept, black is removed")
    if text_button(f"{icons.ICON_FA_FOLDER_OPEN}  {_('Load mask…')}", next(widths), hint):
        actions.append(do(cut_out_editing.ask_mask_to_load))
    hint = _("Save the kept parts as a black and white picture")
    if text_button(f"{icons.ICON_FA_FLOPPY_DISK}  {_('Save mask…')}", next(widths), hint):
        actions.append(do(cut_out_editing.ask_mask_to_save))
    count = len(cut_out.strokes)
    texts = []
    if count:
        texts.append(ngettext("{count:,} stroke", "{count:,} strokes", count).format(count=count))
    if count := len(cut_out.cut_lines):
        text = ngettext("{count:,} knife line", "{count:,} knife lines", count)
        texts.append(text.format(count=count))
    if texts:
        small_text(look, ", ".join(texts))
    return actions


def _holes(session: Session, look: Look, project: Project) -> list[Action]:
    holes = project.layer_runtime.cut.value.holes
    if holes is None or not holes.middles:
        small_text(look, _("There are no holes. Brush away a part inside to make a hole."))
        return []
    text = f"{icons.ICON_FA_CIRCLE_HALF_STROKE}  {_('Click holes')}"
    hint = _("Click in a hole to keep it open, or to fill it")
    return _tool(session, look, "holes", text, hint, width=FILL)


def _tool(
    session: Session, look: Look, tool: CutTool, text: str, hint: str, *, width: float = 0.0
) -> list[Action]:
    """Draw a tool's button. The active tool is highlighted, and its button ends it."""
    palette = look.palette
    is_chosen = session.tools.mode == tool
    imgui.push_style_color(imgui.Col_.button, palette.accent if is_chosen else palette.raised)
    imgui.push_style_color(imgui.Col_.text, palette.on_accent if is_chosen else palette.text)
    pressed = imgui.button(f"{text}###{tool} tool", ImVec2(width, 0))
    imgui.pop_style_color(2)
    draw_tooltip(hint)
    return [do(cut_out_editing.toggle_cut_tool, tool)] if pressed else []


def _state(look: Look, project: Project) -> list[Action]:
    """Draw the progress of the new mesh, or why there is none."""
    resolver = project.key_resolver
    if resolver is not None and resolver.meshing is not None:
        is_stopped = progress_bar(resolver.progress, resolver.status_text)
        return [do(resolving.cancel_solving_keys)] if is_stopped else []
    if project.layer.is_stale and project.layer is project.layer_setup.unbuildable:
        text = _(
            "This cut-out leaves no shape, so the mesh did not change. Change the cut-out, or undo."
        )
        small_text(look, text, look.palette.warning)
    return []
