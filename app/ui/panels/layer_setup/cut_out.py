"""The cut-out of the subject: by colour, brush, knife and mask; and its holes."""

from imgui_bundle import ImVec2, icons_fontawesome_6 as icons, imgui

from app.cut_out import CutOut
from app.editor import Action, CutTool, Project, Session, do
from app.editor.actions.layer_setup import cut_out_editing, resolving
from app.ui.shortcuts.table import BINDINGS
from app.ui.style.sliders import Scale, slider
from app.ui.style.theme import Look
from app.ui.style.widgets import (
    FILL,
    align_right,
    draw_tooltip,
    heading,
    icon_button,
    label,
    option_buttons,
    progress_bar,
    small_text,
    split_line,
    text_button,
)

TOLERANCES = Scale(left=0, right=120)
BRUSHES = Scale(
    left=cut_out_editing.SMALLEST_BRUSH, right=cut_out_editing.LARGEST_BRUSH / 2, logarithmic=True
)
BACKGROUNDS = (("auto", "Automatic"), ("none", "None"), ("colour", "Colour"))
ENCLOSED = (("auto", "Automatic"), ("keep", "Keep"), ("remove", "Remove"))
HAND_TOOLS: tuple[tuple[CutTool, str, str, str], ...] = (
    ("keep", icons.ICON_FA_PAINTBRUSH, "Keep", "Brush over what belongs to the drawing"),
    ("remove", icons.ICON_FA_ERASER, "Remove", "Brush over what is to go"),
    (
        "knife",
        icons.ICON_FA_SCISSORS,
        "Knife",
        "Draw a line between what touches, from outside inwards, to pose both sides apart",
    ),
)


def draw_cut_out_panel(session: Session, look: Look, project: Project) -> list[Action]:
    cut_out = project.layer.cut_out
    heading(look, "Background")
    actions = _background(session, look, project, cut_out)
    heading(look, "By hand", framed=True)
    align_right(1.15 * imgui.get_frame_height())
    if icon_button(
        look,
        icons.ICON_FA_TRASH,
        "forget strokes",
        "Take away all strokes, lines of the knife and the mask",
        enabled=cut_out.is_by_hand,
    ):
        actions.append(do(cut_out_editing.clear_cut_out_strokes))
    actions += _brush(session, look, project)
    actions += _mask(look, cut_out)
    heading(look, "Holes")
    actions += _holes(session, look, project)
    actions += _state(session, look, project)
    return actions


def _background(session: Session, look: Look, project: Project, cut_out: CutOut) -> list[Action]:
    if not project.layer_runtime.is_opaque and cut_out.background == "auto":
        small_text(
            look, "The picture is transparent around the drawing: nothing has to be removed."
        )
    elif project.layer_runtime.is_opaque and project.layer_runtime.cut.value.is_all:
        small_text(look, "The whole picture is the drawing: pick a colour, or brush the rest away.")
    actions: list[Action] = []
    imgui.begin_disabled(cut_out.mask is not None)
    label(look, "Remove")
    kind = "colour" if isinstance(cut_out.background, tuple) else cut_out.background
    match option_buttons(look, "background", BACKGROUNDS, kind):
        case "auto" | "none" as chosen:
            actions.append(do(cut_out_editing.set_background, chosen))
        case "colour":
            actions.append(do(cut_out_editing.toggle_cut_tool, "pick"))
    draw_tooltip(
        "A plain background is found at the picture's border, or has the colour that you pick"
    )
    imgui.end_disabled()
    label(look, "Colour")
    text = f"{icons.ICON_FA_EYE_DROPPER}  Pick"
    actions += _tool(session, look, "pick", text, "Click on the background in the picture")
    if isinstance(cut_out.background, tuple):
        red, green, blue = (level / 255 for level in cut_out.background)
        imgui.same_line()
        imgui.color_button("##background", (red, green, blue, 1.0))
    label(look, "Tolerance")
    hint = "How far the background may vary in colour, 0 to 255"
    entered = slider(look, "tolerance", cut_out.tolerance, TOLERANCES, text="%.0f", hint=hint)
    if entered is not None:
        actions.append(do(cut_out_editing.set_background_tolerance, round(entered.value)))
    label(look, "Inside")
    enclosed = option_buttons(look, "enclosed", ENCLOSED, cut_out.enclosed)
    if enclosed is not None:
        actions.append(do(cut_out_editing.set_enclosed_removed, enclosed))
    draw_tooltip(
        "Parts inside that have the background's colour, as between an arm and the body: automatic "
        "removes vivid colours, but not white, grey and black, which eyes and paper have too; a "
        "click below changes one of them"
    )
    if project.layer_runtime.cut.value.background_like is not None:
        small_text(
            look,
            "Parts inside have the background's colour and stay: tinted blue while a tool is in "
            "hand.",
        )
    if cut_out.mask is not None:
        small_text(look, "A mask was loaded: it takes the place of all this.")
    return actions


def _brush(session: Session, look: Look, project: Project) -> list[Action]:
    actions: list[Action] = []
    widths = split_line(len(HAND_TOOLS))
    for (tool, icon, name, hint), width in zip(HAND_TOOLS, widths, strict=True):
        actions += _tool(session, look, tool, f"{icon}  {name}", hint, width=width)
    label(look, "Size")
    keys = " and ".join(BINDINGS[name].shown_keys for name in ("smaller brush", "larger brush"))
    hint = f"Radius of the brush in pixels of the picture; {keys} change it"
    radius = cut_out_editing.brush_radius(project)
    entered = slider(look, "brush", radius, BRUSHES, text="%.0f", hint=hint)
    if entered is not None:
        actions.append(do(cut_out_editing.set_brush_radius, entered.value))
    return actions


def _mask(look: Look, cut_out: CutOut) -> list[Action]:
    actions: list[Action] = []
    widths = split_line(2)
    hint = "A black and white picture of the same size: white is kept, black is removed"
    if text_button(f"{icons.ICON_FA_FOLDER_OPEN}  Load mask…", next(widths), hint):
        actions.append(do(cut_out_editing.ask_mask_to_load))
    hint = "Save what is kept as a black and white picture"
    if text_button(f"{icons.ICON_FA_FLOPPY_DISK}  Save mask…", next(widths), hint):
        actions.append(do(cut_out_editing.ask_mask_to_save))
    count = len(cut_out.strokes)
    told = ["1 stroke" if count == 1 else f"{count:,} strokes"] if count else []
    if lines := len(cut_out.cut_lines):
        told.append("1 line of the knife" if lines == 1 else f"{lines:,} lines of the knife")
    if told:
        small_text(look, ", ".join(told))
    return actions


def _holes(session: Session, look: Look, project: Project) -> list[Action]:
    holes = project.layer_runtime.cut.value.holes
    if holes is None or not holes.middles:
        small_text(look, "There are none. Where the brush removes a part inside, there is one.")
        return []
    text = f"{icons.ICON_FA_CIRCLE_HALF_STROKE}  Keep or fill by a click"
    hint = "Click in a hole to keep it open, or to fill it"
    return _tool(session, look, "holes", text, hint, width=FILL)


def _tool(
    session: Session, look: Look, tool: CutTool, text: str, hint: str, *, width: float = 0.0
) -> list[Action]:
    """Draw a tool's button. The active tool is highlighted, and its button ends it."""
    palette = look.palette
    is_chosen = session.cutting == tool
    imgui.push_style_color(imgui.Col_.button, palette.accent if is_chosen else palette.raised)
    imgui.push_style_color(imgui.Col_.text, palette.on_accent if is_chosen else palette.text)
    pressed = imgui.button(f"{text}###{tool} tool", ImVec2(width, 0))
    imgui.pop_style_color(2)
    draw_tooltip(hint)
    return [do(cut_out_editing.toggle_cut_tool, tool)] if pressed else []


def _state(session: Session, look: Look, project: Project) -> list[Action]:
    actions: list[Action] = []
    imgui.dummy(ImVec2(0, 0.2 * look.em))
    renewal = project.key_resolver
    if renewal is not None and renewal.meshing is not None:
        if progress_bar(renewal.progress, renewal.status_text):
            actions.append(do(resolving.cancel_solving_keys))
    elif session.cutting is not None:
        hint, keys = "Show the drawing as it is posed", BINDINGS["pose"].shown_keys
        if text_button("Back to posing###done", FILL, hint, keys):
            actions.append(do(cut_out_editing.toggle_cut_tool, None))
    if project.layer.is_stale and project.layer is project.unbuildable:
        small_text(
            look, "The mesh is still that of before: this cut-out gives none. Change it, or undo."
        )
    small_text(
        look, "The mesh follows when the brush rests: handles stay, and every key is posed again."
    )
    return actions
