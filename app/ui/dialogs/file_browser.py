"""The built-in file browser, for machines without system file dialogs."""

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

from imgui_bundle import ImVec2, icons_fontawesome_6 as icons, imgui

from app.editor import Action, FileDialog, Session, do
from app.editor.actions.dialog_actions import browse_files, choose_file, close_dialog
from app.errors import display_name
from app.folders import home_folder
from app.render import Thumbnail
from app.texts import _
from app.ui.dialogs.browser_shortcuts import (
    BrowserShortcut,
    list_recent_shortcuts,
    list_standard_shortcuts,
)
from app.ui.dialogs.browsing import chosen_folder, chosen_path, enter_folder, is_there, mark_entry
from app.ui.dialogs.folder_listing import Entry, Listing, read_folder
from app.ui.shortcuts.keys import ALT, format_chord
from app.ui.style.drawing import show_picture
from app.ui.style.theme import Look, colour_u32
from app.ui.style.widgets import (
    draw_tooltip,
    icon_button,
    main_button,
    shorten_text,
    small_text,
)

LookUp = Callable[[Path], Thumbnail | None]
WIDTH, HEIGHT = 52.0, 24.0  # em, if the window is large enough
PLACES, SIZE, CHANGED, BUTTON = 10.0, 5.5, 9.5, 7.0  # em
ROW = 1.9  # em
LARGEST_SHOWN = 20_000_000  # bytes: larger pictures have an icon instead of a thumbnail
PLACE_FLAGS = imgui.SelectableFlags_.no_auto_close_popups
SEPARATOR = "/"
UP = ALT | int(imgui.Key.up_arrow)
NAME_FIELD = "##file name"
ROW_FLAGS = (
    imgui.SelectableFlags_.span_all_columns
    | imgui.SelectableFlags_.allow_double_click
    | imgui.SelectableFlags_.no_auto_close_popups
)
TABLE_FLAGS = (
    imgui.TableFlags_.scroll_y
    | imgui.TableFlags_.sortable
    | imgui.TableFlags_.borders_outer
    | imgui.TableFlags_.pad_outer_x
)
ENTER = (imgui.Key.enter, imgui.Key.keypad_enter)
# Sort key of each column.
ORDERS: tuple[Callable[[Entry], Any], ...] = (
    lambda entry: entry.path.name.casefold(),
    lambda entry: entry.size,
    lambda entry: entry.changed,
)


class FileBrowser:
    """The file browser. It reads a folder again only if the folder has changed."""

    def __init__(self) -> None:
        self._usual: tuple[BrowserShortcut, ...] = ()
        self._recent: tuple[BrowserShortcut, ...] = ()
        self._listing: Listing | None = None
        self._order = (0, False)  # column, and whether descending
        self._entries: list[Entry] = []  # of the listing, in this order

    def draw(
        self, dialog: FileDialog, session: Session, look: Look, thumbnail: LookUp
    ) -> list[Action]:
        room = imgui.get_main_viewport().size
        size = ImVec2(min(WIDTH * look.em, 0.85 * room.x), min(HEIGHT * look.em, 0.52 * room.y))
        appears = imgui.is_window_appearing()
        if appears:
            self._usual, self._recent = (
                list_standard_shortcuts(),
                list_recent_shortcuts(session.settings.preferences.recent),
            )
        now = _way(dialog, look, size.x)
        now, by_key = self._step(now)
        now = self._places(now, look, size.y)
        imgui.same_line()
        side = PLACES * look.em + imgui.get_style().item_spacing.x
        room = ImVec2(size.x - side, size.y)
        now, is_accepted = self._list(now, look, thumbnail, room, shows_marked=by_key or appears)
        now = _name_field(now, size.x, is_new=appears, is_set=now.name != dialog.name)
        is_accepted |= any(imgui.is_key_pressed(key, repeat=False) for key in ENTER)
        folder, path = chosen_folder(now), chosen_path(now)
        text = now.verb if now.writes else _("Open")
        possible = path is not None or (folder is not None and not now.writes)
        missing = _("Type a name first.") if now.writes else _("Choose a file first.")
        reason = None if possible else missing
        if main_button(look, text, BUTTON * look.em, reason=reason):
            is_accepted = True
            # A save uses the typed name, even if a folder is marked.
            folder = None if now.writes else folder
        imgui.same_line()
        if imgui.button(_("Cancel"), ImVec2(BUTTON * look.em, 0)):
            return [do(close_dialog)]
        name, note = now.name.strip() if path is None else path.name, ""
        if path is not None and now.writes and is_there(Path.is_file, path):
            note = _("{name} will be replaced.")
        elif name and not possible:
            note = _("There is no {name} here.")
        if note:
            imgui.same_line()
            imgui.align_text_to_frame_padding()
            imgui.text_colored(look.palette.warning, note.format(name=display_name(name)))
        if is_accepted and folder is not None:
            now = enter_folder(now, folder)
        elif is_accepted and path is not None:
            return [do(choose_file, now, path)]
        return [] if now is dialog else [do(browse_files, now)]

    def _step(self, dialog: FileDialog) -> tuple[FileDialog, bool]:
        """Move the marked entry by the arrow keys. Return whether they were used."""
        down, up = (imgui.is_key_pressed(key) for key in (imgui.Key.down_arrow, imgui.Key.up_arrow))
        if up and imgui.get_io().key_alt:
            return enter_folder(dialog, dialog.folder.parent), False
        if not self._entries or down == up:
            return dialog, False
        names = [entry.path.name for entry in self._entries]
        if dialog.marked in names:
            index = names.index(dialog.marked) + (1 if down else -1)
        else:
            index = 0 if down else len(names) - 1
        return mark_entry(dialog, self._entries[min(max(index, 0), len(names) - 1)]), True

    def _places(self, dialog: FileDialog, look: Look, height: float) -> FileDialog:
        """Draw the home folders, and the folders of recently opened files."""
        imgui.begin_child("places", ImVec2(PLACES * look.em, height))
        for name, title, places in (
            ("Places", _("Places"), self._usual),
            ("Recent", _("Recent"), self._recent),
        ):
            if not places:
                continue
            small_text(look, title)
            for index, place in enumerate(places):
                is_here = place.folder == dialog.folder
                if imgui.selectable(f"###{name} {index}", is_here, PLACE_FLAGS)[0]:
                    dialog = enter_folder(dialog, place.folder)
                draw_tooltip(display_name(place.folder))
                imgui.same_line(0.3 * look.em)
                imgui.text_colored(look.palette.dim, place.icon)
                imgui.same_line(2.0 * look.em)
                room = imgui.get_content_region_avail().x
                imgui.text_unformatted(shorten_text(place.name, room))
            imgui.dummy(ImVec2(0, 0.4 * look.em))
        imgui.end_child()
        return dialog

    def _list(
        self,
        dialog: FileDialog,
        look: Look,
        thumbnail: LookUp,
        size: ImVec2,
        *,
        shows_marked: bool,
    ) -> tuple[FileDialog, bool]:
        """Draw the entries. Return the dialog with its marked entry; True if double-clicked."""
        is_opened = False
        if not imgui.begin_table("entries", 3, TABLE_FLAGS, size):
            return dialog, is_opened
        imgui.table_setup_column(_("Name"), imgui.TableColumnFlags_.width_stretch)
        imgui.table_setup_column(_("Size"), imgui.TableColumnFlags_.width_fixed, SIZE * look.em)
        imgui.table_setup_column(
            _("Changed"), imgui.TableColumnFlags_.width_fixed, CHANGED * look.em
        )
        imgui.table_setup_scroll_freeze(0, 1)
        imgui.table_headers_row()
        self._read(dialog)
        marked = next(
            (i for i, entry in enumerate(self._entries) if entry.path.name == dialog.marked), None
        )
        clipper = imgui.ListClipper()
        clipper.begin(len(self._entries))
        if marked is not None and shows_marked:
            clipper.include_item_by_index(marked)
        while clipper.step():
            for index in range(clipper.display_start, clipper.display_end):
                entry = self._entries[index]
                imgui.push_id(index)  # two names may look the same
                if _row(entry, look, thumbnail, is_marked=index == marked):
                    dialog = mark_entry(dialog, entry)
                    is_opened = imgui.is_mouse_double_clicked(imgui.MouseButton_.left)
                imgui.pop_id()
                if index == marked and shows_marked:
                    imgui.set_scroll_here_y()
        if not self._entries:
            imgui.table_next_row()
            imgui.table_next_column()
            small_text(look, self._listing.problem if self._listing else "")
        imgui.end_table()
        return dialog, is_opened

    def _read(self, dialog: FileDialog) -> None:
        """Update the entries from the folder and the table's sort order."""
        listing = self._listing
        if listing is None or not listing.is_current(dialog.folder, dialog.suffixes):
            self._listing = read_folder(dialog.folder, dialog.suffixes)
        column = imgui.table_get_sort_specs().get_specs(0)
        is_reversed = column.get_sort_direction() == imgui.SortDirection.descending
        order = (column.column_index, is_reversed)
        if self._listing is listing and self._order == order:
            return
        self._order = order
        entries = sorted(self._listing.entries, key=ORDERS[0]) if self._listing else []
        entries.sort(key=ORDERS[column.column_index], reverse=is_reversed)
        self._entries = sorted(entries, key=lambda entry: not entry.is_folder)


def _way(dialog: FileDialog, look: Look, width: float) -> FileDialog:
    """Draw the buttons that leave the folder: up, home, and each parent folder."""
    start = imgui.get_cursor_pos_x()
    if icon_button(look, icons.ICON_FA_ARROW_UP, "up", _("Parent folder"), keys=format_chord(UP)):
        return enter_folder(dialog, dialog.folder.parent)
    imgui.same_line(0, 0)
    if icon_button(look, icons.ICON_FA_HOUSE, "home", _("Your home folder")):
        return enter_folder(dialog, home_folder())
    imgui.same_line()
    room = width - (imgui.get_cursor_pos_x() - start)
    style = imgui.get_style()
    gap = imgui.calc_text_size(SEPARATOR).x
    shown: list[Path] = []
    for folder in (dialog.folder, *dialog.folder.parents):
        name = imgui.calc_text_size(display_name(folder.name or folder.anchor))
        room -= name.x + 2 * style.frame_padding.x + gap
        if shown and room < 0:
            break
        shown.insert(0, folder)
    for folder in shown:
        imgui.push_style_color(imgui.Col_.button, (0, 0, 0, 0))
        if imgui.button(f"{display_name(folder.name or folder.anchor)}###in {len(folder.parts)}"):
            dialog = enter_folder(dialog, folder)
        imgui.pop_style_color()
        if folder is not shown[-1]:
            imgui.same_line(0, 0)
            # The name of the root is empty; its separator is drawn already.
            imgui.text_disabled(SEPARATOR if folder.name else "")
            imgui.same_line(0, 0)
    return dialog


def _row(entry: Entry, look: Look, thumbnail: LookUp, *, is_marked: bool) -> bool:
    imgui.table_next_row()
    imgui.table_next_column()
    palette, em = look.palette, look.em
    name, height = display_name(entry.path.name), ROW * em
    corner = imgui.get_cursor_screen_pos()
    clicked = imgui.selectable(f"###entry {name}", is_marked, ROW_FLAGS, ImVec2(0, height))[0]
    middle = corner.y + (height - imgui.get_text_line_height()) / 2
    draw_list = imgui.get_window_draw_list()
    image = None if entry.is_folder or entry.size > LARGEST_SHOWN else thumbnail(entry.path)
    if image is not None:
        show_picture(image.texture, image.size, corner, ImVec2(2 * em, height))
    else:
        icon = icons.ICON_FA_FOLDER if entry.is_folder else icons.ICON_FA_FILE
        colour = colour_u32(palette.accent if entry.is_folder else palette.dim)
        inset = (2 * em - imgui.calc_text_size(icon).x) / 2
        draw_list.add_text(ImVec2(corner.x + inset, middle), colour, icon)
    left = corner.x + 2.5 * em
    room = corner.x + imgui.get_column_width() - left - 0.5 * em
    draw_list.add_text(ImVec2(left, middle), colour_u32(palette.text), shorten_text(name, room))
    imgui.table_next_column()
    size = entry.size_in_words
    at_end = imgui.get_content_region_avail().x - imgui.calc_text_size(size).x
    for text, inset in ((size, max(at_end, 0)), (entry.changed_in_words, 0)):
        place = imgui.get_cursor_screen_pos()
        draw_list.add_text(ImVec2(place.x + inset, middle), colour_u32(palette.dim), text)
        if text is size:
            imgui.table_next_column()
    return clicked


def _name_field(dialog: FileDialog, width: float, *, is_new: bool, is_set: bool) -> FileDialog:
    """Draw the field for the name, which has the keyboard focus when the browser opens."""
    if is_new:
        imgui.set_keyboard_focus_here()
    if is_set:
        # An active text field ignores a new value unless it is reloaded explicitly.
        state = imgui.internal.get_input_text_state(imgui.get_id(NAME_FIELD))
        if state is not None:
            state.reload_user_buf_and_move_to_end()
    imgui.set_next_item_width(width)
    hint = _("Folder name") if dialog.wants_folder else _("File name")
    shown = display_name(dialog.name)
    name = imgui.input_text_with_hint(NAME_FIELD, hint, shown)[1]
    return dialog if name == shown else replace(dialog, name=name, marked="")
