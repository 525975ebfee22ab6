"""The view before a picture is open: samples, recent files, and ways to begin."""

from collections.abc import Callable
from pathlib import Path
from typing import NamedTuple

from imgui_bundle import (
    ImVec2,
    hello_imgui,
    icons_fontawesome_6 as icons,
    imgui,
    imgui_ctx,
)

from app.editor import Action, Session, do
from app.editor.actions import tutorials
from app.editor.actions.project_files import files
from app.errors import display_name
from app.render import Thumbnail
from app.texts import _
from app.ui.style.drawing import show_picture
from app.ui.style.theme import LARGE, SMALL, TITLE, Look, colour_u32
from app.ui.style.widgets import bold_text, main_button, push_text_size, text_button

CARD, TALL, GAP, ROW = 11.5, 11.2, 1.0, 2.5  # em
FIRST, FOOT = 6.4, 3.5  # em: height of the first card, and of the text on the other cards
TUTORIAL_SAMPLE = "Giraffe"  # the sample of the tutorial
SAMPLE_FPS = 10.0  # pictures per second of a sample that moves
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


class Previews(NamedTuple):
    """Looks up thumbnails of files, and frames of sample animations."""

    still: Callable[[Path], Thumbnail | None]
    moving: Callable[[Path], list[Thumbnail]]


def draw_welcome(session: Session, look: Look, pictures: Previews) -> list[Action]:
    """Cover the window with samples, and buttons that open the person's own picture."""
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
    # Recent files come first: people who have files look for them, not for samples.
    actions += _recent(session, look, pictures)
    actions += _first(look, pictures)
    actions += _samples(look, pictures)
    imgui.end_group()
    imgui.end()
    return actions


def _greeting(session: Session, look: Look) -> list[Action]:
    actions: list[Action] = []
    with push_text_size(TITLE, look.bold):
        imgui.text(_("Lissom"))
    text = _("Pose a drawing with a few handles, and get in-betweens that never fold.")
    with push_text_size(LARGE):
        imgui.text_colored(look.palette.dim, text)
    imgui.dummy(ImVec2(0, 0.8 * look.em))
    text = f"{icons.ICON_FA_FOLDER_OPEN}  {_('Open image or project…')}"
    if main_button(look, text, 16 * look.em):
        actions.append(files.ask_file_to_open.action)
    imgui.same_line(0, look.em)
    imgui.align_text_to_frame_padding()
    busy = next((kind for kind in session.jobs.kinds), None)
    imgui.text_colored(
        look.palette.dim,
        _("{job}…").format(job=busy.label) if busy else _("or drop a picture here"),
    )
    imgui.dummy(ImVec2(0, 1.0 * look.em))
    return actions


def _first(look: Look, pictures: Previews) -> list[Action]:
    """Draw the cards that begin a first animation, with the giraffe or with an own drawing."""
    sample = next((each for each in tutorials.sample_files() if each.name == TUTORIAL_SAMPLE), None)
    if sample is None:
        return []
    actions: list[Action] = []
    palette, em = look.palette, look.em
    corner, size = imgui.get_cursor_screen_pos(), ImVec2(WIDTH * em, FIRST * em)
    imgui.set_next_item_allow_overlap()
    if imgui.invisible_button("make it bow", size):
        actions.append(do(tutorials.begin_tutorial))
    _frame(look, corner, size, is_hot=imgui.is_item_hovered())
    room = ImVec2(FIRST * em, size.y - 0.8 * em)
    _show_sample(sample, pictures, corner + ImVec2(0.8 * em, 0.4 * em), room)
    draw_list, left = imgui.get_window_draw_list(), corner.x + (FIRST + 2.2) * em
    with push_text_size(LARGE, look.bold):
        draw_list.add_text(
            ImVec2(left, corner.y + 0.9 * em), colour_u32(palette.text), _("Make this giraffe bow")
        )
    text = _("Five steps to a first animation, from a handle to a GIF. It takes about a minute.")
    draw_list.add_text(ImVec2(left, corner.y + 2.5 * em), colour_u32(palette.dim), text)
    below = imgui.get_cursor_pos()
    imgui.set_cursor_screen_pos(ImVec2(left, corner.y + 4.1 * em))
    if text_button(_("…or with your own drawing"), hint=_("Open it and follow the same steps")):
        actions.append(do(tutorials.begin_tutorial_with_own_drawing))
    imgui.set_cursor_pos(below)
    imgui.dummy(ImVec2(0, 0.4 * em))
    return actions


def _samples(look: Look, pictures: Previews) -> list[Action]:
    actions: list[Action] = []
    bold_text(look, _("Try one of these"))
    imgui.dummy(ImVec2(0, 0.2 * look.em))
    for index, sample in enumerate(tutorials.sample_files()):
        if index % 4:
            imgui.same_line(0, GAP * look.em)
        elif index:
            imgui.dummy(ImVec2(0, GAP * look.em - 2 * imgui.get_style().item_spacing.y))
        if _card(look, sample, pictures):
            actions.append(do(files.open_file, sample.file))
    return actions


def _card(look: Look, sample: tutorials.SampleFile, pictures: Previews) -> bool:
    palette, em = look.palette, look.em
    corner, size = imgui.get_cursor_screen_pos(), ImVec2(CARD * em, TALL * em)
    pressed = imgui.invisible_button(f"sample {sample.name}", size)
    _frame(look, corner, size, is_hot=imgui.is_item_hovered())
    room = ImVec2(size.x - 1.4 * em, size.y - (FOOT + 0.8) * em)
    _show_sample(sample, pictures, corner + ImVec2(0.7 * em, 0.7 * em), room)
    draw_list, opposite = imgui.get_window_draw_list(), corner + size
    text = ImVec2(corner.x + 0.9 * em, opposite.y - (FOOT - 0.45) * em)
    draw_list.add_text(text, colour_u32(palette.text), _(sample.name))
    end = ImVec2(opposite.x - 0.9 * em - imgui.calc_text_size(sample.what).x, text.y)
    draw_list.add_text(end, colour_u32(palette.dim), sample.what)
    with push_text_size(SMALL):
        draw_list.add_text(text + ImVec2(0, 1.4 * em), colour_u32(palette.dim), sample.story)
    return pressed


def _frame(look: Look, corner: ImVec2, size: ImVec2, *, is_hot: bool) -> None:
    """Draw the background of a card, brighter under the pointer."""
    palette, draw_list, opposite = look.palette, imgui.get_window_draw_list(), corner + size
    ground, edge, width = palette.panel, palette.line, 1.0
    if is_hot:
        ground, edge, width = palette.raised, palette.accent, 1.5
    draw_list.add_rect_filled(corner, opposite, colour_u32(ground), 0.6 * look.em)
    draw_list.add_rect(corner, opposite, colour_u32(edge), 0.6 * look.em, width)


def _show_sample(
    sample: tutorials.SampleFile, pictures: Previews, corner: ImVec2, room: ImVec2
) -> None:
    """Draw a sample. It moves while the pointer is on its card, which is the last item."""
    began, now = imgui.get_id(f"{sample.name} since"), imgui.get_time()
    storage = imgui.get_state_storage()
    image = pictures.still(sample.picture)
    if not imgui.is_item_hovered():
        storage.set_float(began, now)
    elif moments := pictures.moving(sample.moving):
        # The next picture of the sample is due soon, even if nothing else changes.
        hello_imgui.request_refresh()
        image = moments[int((now - storage.get_float(began, now)) * SAMPLE_FPS) % len(moments)]
    if image is not None:
        show_picture(image.texture, image.size, corner, room)


def _recent(session: Session, look: Look, pictures: Previews) -> list[Action]:
    actions: list[Action] = []
    recent = files.recent_files(session)[:MOST_RECENT]
    if not recent:
        return actions
    bold_text(look, _("Recent"))
    for index, (path, is_there) in enumerate(recent):
        if index % 2:
            imgui.same_line(0, GAP * look.em)
        # The text is grey but the row is not disabled: a click removes the file from the list.
        colour = imgui.Col_.text if is_there else imgui.Col_.text_disabled
        imgui.push_style_color(imgui.Col_.text, imgui.get_style_color_vec4(colour))
        if _row(look, path, index, pictures.still(path) if is_there else None, is_there=is_there):
            actions.append(do(files.open_recent_file, path))
        imgui.pop_style_color()
    imgui.dummy(ImVec2(0, 0.4 * look.em))
    return actions


def _row(look: Look, path: Path, index: int, image: Thumbnail | None, *, is_there: bool) -> bool:
    """Draw a recent file: its picture, its name, and its folder below the name."""
    em, corner = look.em, imgui.get_cursor_screen_pos()
    size = ImVec2((WIDTH - GAP) / 2 * em, ROW * em)
    end = corner + size
    clicked = imgui.selectable(f"###recent {index}", False, 0, size)[0]  # noqa: FBT003
    imgui.push_clip_rect(corner, end, True)  # noqa: FBT003 - within the window's own
    if image is None:
        _write(icons.ICON_FA_CLOCK_ROTATE_LEFT, corner.x + em, corner.y + 0.5 * size.y)
    else:
        show_picture(image.texture, image.size, corner, ImVec2(3 * em, size.y))
    _write(display_name(path.name), corner.x + 3.6 * em, corner.y + 0.3 * size.y)
    where = str(path.parent) if is_there else _("not found in {folder}").format(folder=path.parent)
    with push_text_size(SMALL), imgui_ctx.push_style_color(imgui.Col_.text, look.palette.dim):
        _write(display_name(where), corner.x + 3.6 * em, corner.y + 0.72 * size.y)
    imgui.pop_clip_rect()
    return clicked


def _write(text: str, left: float, middle: float) -> None:
    """Draw a line of text over the last item, centred at a height."""
    place = ImVec2(left, middle - imgui.get_text_line_height() / 2)
    imgui.get_window_draw_list().add_text(place, imgui.get_color_u32(imgui.Col_.text), text)
