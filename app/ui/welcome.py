"""What is shown before a picture is opened: samples, recent files, and how to begin."""

from collections.abc import Callable
from pathlib import Path

from imgui_bundle import ImVec2, icons_fontawesome_6 as icons, imgui, imgui_ctx

from app.editor import Action, Session, do
from app.editor.actions import files
from app.errors import shown_name
from app.render import Thumbnail
from app.ui.shortcuts import BINDINGS
from app.ui.style import LARGE, SMALL, TITLE, Look, bold, ink, main_button, show_picture, sized

Look_up = Callable[[Path], Thumbnail | None]
CARD, GAP, ROW = 11.5, 1.0, 2.5  # em
WIDTH = 4 * CARD + 3 * GAP
MOST_RECENT = 6
FLAGS = (
    imgui.WindowFlags_.no_title_bar
    | imgui.WindowFlags_.no_resize
    | imgui.WindowFlags_.no_collapse
    | imgui.WindowFlags_.no_docking
    | imgui.WindowFlags_.no_saved_settings
    | imgui.WindowFlags_.no_move
    | imgui.WindowFlags_.no_nav_focus
)


def draw(session: Session, look: Look, thumbnail: Look_up) -> list[Action]:
    """Cover the window with samples to open and the ways to open one's own picture."""
    viewport = imgui.get_main_viewport()
    imgui.set_next_window_pos(viewport.work_pos)
    status = imgui.get_frame_height() + look.em
    imgui.set_next_window_size(ImVec2(viewport.work_size.x, viewport.work_size.y - status))
    imgui.push_style_var(imgui.StyleVar_.window_rounding, 0.0)
    imgui.push_style_color(imgui.Col_.window_bg, look.palette.desk)
    imgui.begin("Welcome", flags=FLAGS)
    imgui.pop_style_color()
    imgui.pop_style_var()
    left = max(GAP * look.em, (viewport.work_size.x - WIDTH * look.em) / 2)
    imgui.set_cursor_pos(ImVec2(left, max(1.5 * look.em, 0.07 * viewport.work_size.y)))
    imgui.begin_group()
    actions = _greeting(session, look)
    actions += _samples(look, thumbnail)
    actions += _recent(session, look, thumbnail)
    imgui.end_group()
    imgui.end()
    return actions


def _greeting(session: Session, look: Look) -> list[Action]:
    actions: list[Action] = []
    with sized(TITLE, look.bold):
        imgui.text("Lissom")
    told = "Pose a drawing with a few handles, and get in-betweens that never fold."
    with sized(LARGE):
        imgui.text_colored(look.palette.dim, told)
    imgui.dummy(ImVec2(0, 0.8 * look.em))
    binding = BINDINGS["open"]
    if main_button(look, f"{icons.ICON_FA_FOLDER_OPEN}  Open image or project…", 16 * look.em):
        actions.append(binding.action)
    imgui.same_line(0, look.em)
    imgui.align_text_to_frame_padding()
    busy = next((kind for kind in session.jobs.kinds), None)
    imgui.text_colored(look.palette.dim, f"{busy.label}…" if busy else "or drop a picture here")
    imgui.dummy(ImVec2(0, 1.0 * look.em))
    return actions


def _samples(look: Look, thumbnail: Look_up) -> list[Action]:
    actions: list[Action] = []
    bold(look, "Try one of these")
    imgui.dummy(ImVec2(0, 0.2 * look.em))
    for index, sample in enumerate(files.samples()):
        if index % 4:
            imgui.same_line(0, GAP * look.em)
        elif index:
            imgui.dummy(ImVec2(0, GAP * look.em - 2 * imgui.get_style().item_spacing.y))
        if _card(look, sample, thumbnail(sample.picture)):
            actions.append(do(files.open_file, sample.file))
    return actions


def _card(look: Look, sample: files.SampleFile, image: Thumbnail | None) -> bool:
    palette = look.palette
    size = ImVec2(CARD * look.em, 0.88 * CARD * look.em)
    corner = imgui.get_cursor_screen_pos()
    pressed = imgui.invisible_button(f"sample {sample.name}", size)
    hovered = imgui.is_item_hovered()
    opposite = corner + size
    draw_list = imgui.get_window_draw_list()
    ground, edge, width = palette.panel, palette.line, 1.0
    if hovered:
        ground, edge, width = palette.raised, palette.accent, 1.5
    draw_list.add_rect_filled(corner, opposite, ink(ground), 0.6 * look.em)
    draw_list.add_rect(corner, opposite, ink(edge), 0.6 * look.em, width)
    foot = 2.3 * look.em
    if image is not None:
        place = corner + ImVec2(0.7 * look.em, 0.7 * look.em)
        room = ImVec2(size.x - 1.4 * look.em, size.y - foot - 0.8 * look.em)
        show_picture(image.texture, image.size, place, room)
    text = ImVec2(corner.x + 0.9 * look.em, opposite.y - foot + 0.45 * look.em)
    draw_list.add_text(text, ink(palette.text), sample.name)
    end = ImVec2(opposite.x - 0.9 * look.em - imgui.calc_text_size(sample.what).x, text.y)
    draw_list.add_text(end, ink(palette.dim), sample.what)
    return pressed


def _recent(session: Session, look: Look, thumbnail: Look_up) -> list[Action]:
    actions: list[Action] = []
    recent = files.recent_files(session)[:MOST_RECENT]
    if not recent:
        return actions
    imgui.dummy(ImVec2(0, 0.8 * look.em))
    bold(look, "Recent")
    for index, (path, is_there) in enumerate(recent):
        if index % 2:
            imgui.same_line(0, GAP * look.em)
        # Greyed and not disabled: a click takes it off the list.
        colour = imgui.Col_.text if is_there else imgui.Col_.text_disabled
        imgui.push_style_color(imgui.Col_.text, imgui.get_style_color_vec4(colour))
        if _row(look, path, index, thumbnail(path) if is_there else None, is_there=is_there):
            actions.append(do(files.open_recent, path))
        imgui.pop_style_color()
    return actions


def _row(look: Look, path: Path, index: int, image: Thumbnail | None, *, is_there: bool) -> bool:
    """Show a recent file: its picture, its name, and its folder below."""
    em, corner = look.em, imgui.get_cursor_screen_pos()
    size = ImVec2((WIDTH - GAP) / 2 * em, ROW * em)
    end = corner + size
    clicked, _ = imgui.selectable(f"###recent {index}", False, 0, size)  # noqa: FBT003
    imgui.push_clip_rect(corner, end, True)  # noqa: FBT003 - within the window's own
    if image is None:
        _write(icons.ICON_FA_CLOCK_ROTATE_LEFT, corner.x + em, corner.y + 0.5 * size.y)
    else:
        show_picture(image.texture, image.size, corner, ImVec2(3 * em, size.y))
    _write(shown_name(path.name), corner.x + 3.6 * em, corner.y + 0.3 * size.y)
    where = str(path.parent) if is_there else f"not found in {path.parent}"
    with sized(SMALL), imgui_ctx.push_style_color(imgui.Col_.text, look.palette.dim):
        _write(shown_name(where), corner.x + 3.6 * em, corner.y + 0.72 * size.y)
    imgui.pop_clip_rect()
    return clicked


def _write(text: str, left: float, middle: float) -> None:
    """Draw a line of text over what was drawn last, with its middle at a height."""
    place = ImVec2(left, middle - imgui.get_text_line_height() / 2)
    imgui.get_window_draw_list().add_text(place, imgui.get_color_u32(imgui.Col_.text), text)
