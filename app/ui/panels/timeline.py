"""Keys in time: ruler, playhead, work range, keys and the easing between them."""

from dataclasses import replace

from imgui_bundle import ImVec2, imgui
from imgui_bundle import icons_fontawesome_6 as icons

from app.actions import editing, playback, timing, viewing
from app.actions.action import Action, do
from app.document.easing import PRESETS
from app.document.model import Document
from app.document.settings import VARIANTS
from app.session import Lassoing, Project, Scrubbing, Session, Shifting, Trimming
from app.ui.bars import bound_button
from app.ui.panels.easing import draw_curve, edit_easing
from app.ui.shortcuts import BINDINGS
from app.ui.theme import SMALL, Look, ink
from app.ui.widgets import icon_button, tip

VARIANT_NAMES = {
    "metric": "Metric",
    "nu": "ν",
    "scaled-eta": "η, scaled",
    "eta": "η, unscaled",
    "linear": "Linear",
}
RULER, KEY = 1.7, 0.52  # em: height of the ruler, and half a key's diagonal
MARGIN = 1.2  # em: left and right of the frames
TICK_ROOM = 3.4  # em: at least between numbers
STEPS = (1, 2, 5, 10, 20, 24, 50, 100, 200, 500, 1000, 2000, 5000, 10000)
WHEEL = 1.2


def draw(session: Session, look: Look) -> list[Action]:
    """Draw the transport and the track."""
    project = session.project
    if project is None:
        return []
    actions = _transport(session, look, project)
    return actions + _track(session, look, project)


def _transport(session: Session, look: Look, project: Project) -> list[Action]:
    actions: list[Action] = []
    document = project.document
    is_playing = project.playhead.since is not None
    for name in ("start", "back", "play", "on", "end"):
        icon = icons.ICON_FA_PAUSE if name == "play" and is_playing else ""
        actions += bound_button(session, look, name, icon)
        imgui.same_line(0, 0.1 * look.em)
    imgui.same_line(0, 0.8 * look.em)
    actions += _numbers(session, look, project)
    imgui.same_line(0, 0.8 * look.em)
    if icon_button(
        look,
        icons.ICON_FA_REPEAT,
        "loop",
        "Loop: the end leads back to the beginning",
        keys=BINDINGS["loop"].keys_in_words,
        active=document.loop,
    ):
        actions.append(do(timing.toggle_loop))
    imgui.same_line(0, 0.1 * look.em)
    actions += bound_button(session, look, "insert key")
    imgui.same_line(0, 0.1 * look.em)
    if icon_button(look, icons.ICON_FA_BARS, "keys menu", "What can be done with the keys"):
        imgui.open_popup("keys")
    actions += _keys_menu(project)
    imgui.same_line(0, 0.1 * look.em)
    if icon_button(
        look, icons.ICON_FA_GHOST, "ghosts", "Onion skin", active=session.overlays.onion
    ):
        imgui.open_popup("ghosts")
    actions += _ghosts_menu(session, look)
    actions += _variant(look, document)
    return actions


def _numbers(session: Session, look: Look, project: Project) -> list[Action]:
    actions: list[Action] = []
    document = project.document
    imgui.push_font(look.mono, 0)
    imgui.set_next_item_width(3.6 * look.em)
    changed, frame = imgui.drag_int("##frame", playback.current_frame(session, project), 0.2)
    imgui.pop_font()
    tip("The present frame: drag or double-click to change it")
    if changed:
        actions.append(do(playback.seek, frame))
    imgui.same_line()
    imgui.text_disabled("of")
    imgui.same_line()
    imgui.push_font(look.mono, 0)
    imgui.set_next_item_width(3.6 * look.em)
    changed, last = imgui.input_int(
        "##last", document.frames.last, 0, 0, imgui.InputTextFlags_.enter_returns_true
    )
    imgui.pop_font()
    tip("The last frame")
    if changed:
        actions.append(do(timing.set_frames, document.frames.first, last))
    imgui.same_line(0, 0.8 * look.em)
    imgui.set_next_item_width(4.8 * look.em)
    changed, fps = imgui.drag_float("##fps", document.fps, 0.1, 1.0, 120.0, "%.4g fps")
    tip("Frames per second")
    if changed and fps > 0:
        actions.append(do(timing.set_fps, round(fps, 3)))
    imgui.same_line()
    imgui.set_next_item_width(4.2 * look.em)
    if imgui.begin_combo("##speed", f"{project.playhead.speed:g}×"):
        actions += [
            do(playback.set_speed, speed)
            for speed in playback.SPEEDS
            if imgui.selectable(f"{speed:g}×", speed == project.playhead.speed)[0]
        ]
        imgui.end_combo()
    tip("How fast it plays here; the animation itself stays as it is")
    return actions


def _keys_menu(project: Project) -> list[Action]:
    actions: list[Action] = []
    if not imgui.begin_popup("keys"):
        return actions
    several = "chosen keys" if len(project.chosen) > 1 else "everything"
    if imgui.menu_item_simple("Last key = first key"):
        actions.append(do(timing.match_ends))
    if imgui.menu_item_simple(f"Reverse {several}"):
        actions.append(do(timing.reverse))
    if imgui.begin_menu(f"Scale time of {several}"):
        for factor, name in ((0.5, "½ ×"), (2 / 3, "⅔ ×"), (1.5, "1.5 ×"), (2.0, "2 ×")):
            if imgui.menu_item_simple(name):
                actions.append(do(timing.scale, factor))
        imgui.end_menu()
    if imgui.menu_item_simple("Play all frames", enabled=project.document.work is not None):
        actions.append(do(timing.use_all_frames))
    imgui.end_popup()
    return actions


def _ghosts_menu(session: Session, look: Look) -> list[Action]:
    actions: list[Action] = []
    if not imgui.begin_popup("ghosts"):
        return actions
    overlays = session.overlays
    changed, _ = imgui.checkbox("Onion skin", overlays.onion)
    if changed:
        actions.append(do(viewing.toggle, "onion"))
    values = [overlays.ghosts_before, overlays.ghosts_after, overlays.ghost_step]
    edited = False
    for index, (name, low, high) in enumerate(
        (
            ("before", 0, viewing.MOST_GHOSTS),
            ("after", 0, viewing.MOST_GHOSTS),
            ("frames apart", 1, 24),
        )
    ):
        imgui.set_next_item_width(8 * look.em)
        changed, values[index] = imgui.slider_int(name, values[index], low, high)
        edited |= changed
    if edited:
        actions.append(do(viewing.set_ghosts, *values))
    imgui.end_popup()
    return actions


def _variant(look: Look, document: Document) -> list[Action]:
    actions: list[Action] = []
    width = 8.0 * look.em
    imgui.same_line(max(imgui.get_cursor_pos_x(), imgui.get_window_width() - width - look.em))
    imgui.set_next_item_width(width)
    if imgui.begin_combo("##variant", VARIANT_NAMES[document.variant]):
        actions += [
            do(timing.set_variant, variant)
            for variant in VARIANTS
            if imgui.selectable(VARIANT_NAMES[variant], variant == document.variant)[0]
        ]
        imgui.end_combo()
    tip("How in-betweens are made. Linear is for comparison: it may fold.")
    return actions


class _Track:
    """Where the frames are on the screen."""

    def __init__(self, look: Look, project: Project) -> None:
        self.look = look
        self.corner = imgui.get_cursor_screen_pos()
        self.size = imgui.get_content_region_avail()
        frames = project.document.frames
        self.first, self.last = project.span or (float(frames.first), float(frames.last))
        self.margin = MARGIN * look.em
        self.per_frame = (self.size.x - 2 * self.margin) / max(self.last - self.first, 1.0)
        self.ruler = self.corner.y + RULER * look.em
        self.bottom = self.corner.y + self.size.y
        self.middle = (self.ruler + self.bottom) / 2

    def x(self, frame: float) -> float:
        return self.corner.x + self.margin + (frame - self.first) * self.per_frame

    def frame(self, x: float) -> float:
        return self.first + (x - self.corner.x - self.margin) / self.per_frame

    @property
    def pointed(self) -> float:
        return self.frame(imgui.get_mouse_pos().x)


def _track(session: Session, look: Look, project: Project) -> list[Action]:
    track = _Track(look, project)
    if min(track.size.x - 2 * track.margin, track.size.y - 2 * look.em) < look.em:
        return []
    draw_list = imgui.get_window_draw_list()
    end = ImVec2(track.corner.x + track.size.x, track.bottom)
    draw_list.push_clip_rect(track.corner, end, True)  # noqa: FBT003
    _background(look, project, track)
    actions = _ground(track)
    actions += _work_range(look, project, track)
    actions += _intervals(look, project, track)
    actions += _keys(session, look, project, track)
    _playhead(session, look, project, track)
    actions += _go_on(session, project, track)
    draw_list.pop_clip_rect()
    return actions


def _background(look: Look, project: Project, track: _Track) -> None:
    palette, draw_list = look.palette, imgui.get_window_draw_list()
    right = track.corner.x + track.size.x
    draw_list.add_rect_filled(
        ImVec2(track.corner.x, track.ruler), ImVec2(right, track.bottom), ink(palette.desk), 6.0
    )
    frames, played = project.document.frames, project.document.played
    draw_list.add_rect_filled(
        ImVec2(track.x(played.first), track.ruler),
        ImVec2(track.x(played.last), track.bottom),
        ink(palette.raised, 0.55),
    )
    step = next((s for s in STEPS if s * track.per_frame >= TICK_ROOM * look.em), STEPS[-1])
    small = step / 5 if step % 5 == 0 else step / 2 if step % 2 == 0 else step
    size = SMALL * imgui.get_style().font_size_base
    imgui.push_font(look.mono, size)
    frame = float(frames.first)
    while frame <= frames.last:
        x = track.x(frame)
        if track.corner.x - 40 <= x <= right + 40:
            large = (frame - frames.first) % step == 0
            top = track.ruler - (0.5 if large else 0.25) * look.em
            draw_list.add_line(ImVec2(x, top), ImVec2(x, track.ruler), ink(palette.dim, 0.7))
            if large:
                draw_list.add_line(
                    ImVec2(x, track.ruler), ImVec2(x, track.bottom), ink(palette.line, 0.5)
                )
                text = f"{frame:.0f}"
                width = imgui.calc_text_size(text).x
                draw_list.add_text(
                    ImVec2(x - width / 2, track.corner.y + 0.05 * look.em), ink(palette.dim), text
                )
        frame += small
    imgui.pop_font()


def _ground(track: _Track) -> list[Action]:
    """Take scrubbing on the ruler, a lasso on the track, and the wheel."""
    actions: list[Action] = []
    imgui.set_next_item_allow_overlap()
    imgui.invisible_button("ruler", ImVec2(track.size.x, track.ruler - track.corner.y))
    if imgui.is_item_activated():
        actions.append(do(timing.begin, Scrubbing()))
    hovered = imgui.is_item_hovered()
    imgui.set_cursor_screen_pos(ImVec2(track.corner.x, track.ruler))
    imgui.set_next_item_allow_overlap()
    imgui.invisible_button("track", ImVec2(track.size.x, track.bottom - track.ruler))
    if imgui.is_item_activated():
        keeps = imgui.get_io().key_shift
        actions.append(do(timing.begin, Lassoing(start=track.pointed, keeps=keeps)))
    hovered |= imgui.is_item_hovered(imgui.HoveredFlags_.allow_when_overlapped_by_item)
    io = imgui.get_io()
    if hovered and io.mouse_wheel:
        factor = WHEEL ** (-io.mouse_wheel)
        pointed = track.pointed
        first = pointed - (pointed - track.first) * factor
        last = pointed + (track.last - pointed) * factor
        actions.append(do(timing.look_at, first, last))
    if hovered and imgui.is_mouse_down(imgui.MouseButton_.middle) and io.mouse_delta.x:
        shift = io.mouse_delta.x / track.per_frame
        actions.append(do(timing.look_at, track.first - shift, track.last - shift))
    return actions


def _work_range(look: Look, project: Project, track: _Track) -> list[Action]:
    actions: list[Action] = []
    played, palette = project.document.played, look.palette
    draw_list = imgui.get_window_draw_list()
    for name, frame, is_last in (("first", played.first, False), ("last", played.last, True)):
        x = track.x(frame)
        width, height = 0.45 * look.em, 0.75 * look.em
        left = x if is_last else x - width
        top = track.ruler - height
        imgui.set_cursor_screen_pos(ImVec2(left, top))
        imgui.set_next_item_allow_overlap()
        imgui.invisible_button(f"{name} of work range", ImVec2(width, height))
        hot = imgui.is_item_hovered() or imgui.is_item_active()
        draw_list.add_rect_filled(
            ImVec2(left, top),
            ImVec2(left + width, track.ruler),
            ink(palette.accent if hot else palette.dim, 0.9),
            0.15 * look.em,
        )
        tip(f"Where playing {'ends' if is_last else 'begins'}: drag")
        if imgui.is_item_activated():
            actions.append(do(timing.begin, Trimming(last=is_last)))
    return actions


def _intervals(look: Look, project: Project, track: _Track) -> list[Action]:
    """Draw how time runs between the keys; a click chooses the key before."""
    actions: list[Action] = []
    document, palette = project.document, look.palette
    reach = KEY * look.em
    for key, following in zip(document.keys, document.keys[1:], strict=False):
        low, high = track.x(key.frame) + 1.4 * reach, track.x(following.frame) - 1.4 * reach
        if high - low < look.em:
            continue
        chosen = key.frame in project.chosen
        height = min(1.6 * look.em, 0.5 * (track.bottom - track.ruler))
        corner = ImVec2(low, track.middle - height / 2)
        colour = ink(palette.accent if chosen else palette.dim, 0.95 if chosen else 0.55)
        draw_curve(key.easing, corner, ImVec2(high - low, height), colour, 1.6)
        imgui.set_cursor_screen_pos(corner)
        imgui.set_next_item_allow_overlap()
        if imgui.invisible_button(f"interval {key.frame}", ImVec2(high - low, height)):
            actions.append(do(timing.choose, frozenset({key.frame})))
            imgui.open_popup(f"easing {key.frame}")
        tip(f"{key.easing.name.capitalize()}: click to change how time runs here")
        if imgui.begin_popup(f"easing {key.frame}"):
            actions += edit_easing(look, key.easing)
            imgui.end_popup()
    return actions


def _keys(session: Session, look: Look, project: Project, track: _Track) -> list[Action]:
    actions: list[Action] = []
    shifting = session.time_pointer if isinstance(session.time_pointer, Shifting) else None
    copies = imgui.get_io().key_ctrl
    for key in project.document.keys:
        chosen = key.frame in project.chosen
        moved = shifting is not None and chosen
        if not moved or copies:
            _diamond(
                look, track, key.frame, chosen=chosen, certified=key.pose.certificate.certified
            )
        if moved and shifting is not None:
            _diamond(look, track, key.frame + shifting.by, chosen=True, certified=True)
        reach = 1.2 * KEY * look.em
        x = track.x(key.frame)
        imgui.set_cursor_screen_pos(ImVec2(x - reach, track.middle - reach))
        imgui.set_next_item_allow_overlap()
        imgui.invisible_button(f"key {key.frame}", ImVec2(2 * reach, 2 * reach))
        if imgui.is_item_activated():
            actions += _press_key(project, key.frame)
        if imgui.is_item_hovered() and imgui.is_mouse_double_clicked(0):
            actions.append(do(playback.seek, key.frame))
        if imgui.is_item_clicked(imgui.MouseButton_.right):
            actions.append(
                do(
                    timing.choose,
                    project.chosen | {key.frame} if chosen else frozenset({key.frame}),
                )
            )
            imgui.open_popup(f"menu of key {key.frame}")
        if session.time_pointer is None:
            tip(f"Key at frame {key.frame}: drag to move, Ctrl+drag to copy, Del deletes")
        actions += _key_menu(key.frame)
    return actions


def _diamond(look: Look, track: _Track, frame: int, *, chosen: bool, certified: bool) -> None:
    palette, draw_list = look.palette, imgui.get_window_draw_list()
    x, y, reach = track.x(frame), track.middle, KEY * look.em
    corners = (
        ImVec2(x, y - reach),
        ImVec2(x + reach, y),
        ImVec2(x, y + reach),
        ImVec2(x - reach, y),
    )
    fill = palette.accent if chosen else palette.text if certified else palette.danger
    draw_list.add_quad_filled(*corners, ink(fill))
    draw_list.add_quad(*corners, ink(palette.desk), 1.5)


def _press_key(project: Project, frame: int) -> list[Action]:
    chosen = project.chosen
    if imgui.get_io().key_shift:
        return [do(timing.choose, chosen ^ {frame})]
    keep = chosen if frame in chosen else frozenset({frame})
    return [do(timing.choose, keep), do(timing.begin, Shifting(start=frame))]


def _key_menu(frame: int) -> list[Action]:
    actions: list[Action] = []
    if not imgui.begin_popup(f"menu of key {frame}"):
        return actions
    if imgui.menu_item_simple(f"{icons.ICON_FA_TRASH}  Delete", "Del"):
        actions.append(do(editing.delete))
    if imgui.begin_menu("Easing"):
        for name, preset in PRESETS.items():
            if imgui.menu_item_simple(name.capitalize()):
                actions.append(do(timing.set_easing, preset))
        imgui.end_menu()
    if imgui.menu_item_simple("Go there", "double click"):
        actions.append(do(playback.seek, frame))
    imgui.end_popup()
    return actions


def _playhead(session: Session, look: Look, project: Project, track: _Track) -> None:
    palette, draw_list = look.palette, imgui.get_window_draw_list()
    x = track.x(playback.current_frame(session, project))
    colour = ink(palette.warning if project.loose is not None else palette.accent)
    draw_list.add_line(ImVec2(x, track.ruler - 0.2 * look.em), ImVec2(x, track.bottom), colour, 1.5)
    half, top = 0.4 * look.em, track.corner.y + 0.75 * look.em
    draw_list.add_rect_filled(
        ImVec2(x - half, top), ImVec2(x + half, track.ruler - half), colour, 2
    )
    draw_list.add_triangle_filled(
        ImVec2(x - half, track.ruler - half - 0.5),
        ImVec2(x + half, track.ruler - half - 0.5),
        ImVec2(x, track.ruler + 0.1 * look.em),
        colour,
    )


def _go_on(session: Session, project: Project, track: _Track) -> list[Action]:
    """Follow the pointer in what it began in the timeline."""
    held = imgui.is_mouse_down(imgui.MouseButton_.left)
    end = [] if held else [do(timing.begin, None)]
    pointed = round(track.pointed)
    match session.time_pointer:
        case Scrubbing() if held:
            return [do(playback.scrub, pointed)]
        case Trimming(last=is_last) if held:
            return [do(timing.trim, pointed, is_last)]
        case Shifting() as gesture:
            return _shift(project, gesture, pointed, held=held)
        case Lassoing() as gesture:
            return _lasso(project, track, gesture, held=held) + end
        case None:
            return []
    return end


def _shift(project: Project, gesture: Shifting, pointed: int, *, held: bool) -> list[Action]:
    if not held:
        return [do(timing.drop_keys, gesture, imgui.get_io().key_ctrl)]
    first = min(project.chosen, default=0)
    offset = max(pointed - gesture.start, -first)
    return [do(timing.begin, replace(gesture, by=offset))] if offset != gesture.by else []


def _lasso(project: Project, track: _Track, gesture: Lassoing, *, held: bool) -> list[Action]:
    low, high = sorted((gesture.start, track.pointed))
    if not held:
        inside = frozenset(k.frame for k in project.document.keys if low <= k.frame <= high)
        return [do(timing.choose, inside | project.chosen if gesture.keeps else inside)]
    draw_list = imgui.get_window_draw_list()
    box = (ImVec2(track.x(low), track.ruler), ImVec2(track.x(high), track.bottom))
    draw_list.add_rect_filled(*box, ink(track.look.palette.accent, 0.15))
    draw_list.add_rect(*box, ink(track.look.palette.accent, 0.8))
    return []
