"""The window and the command line in a language that no person speaks: run as a script.

Every text of the catalogue is written in full-width letters. A word in ASCII letters is thus a
value, such as a name or a number with its unit, or a text that is missing in the catalogue. The
script prints the missing texts, a line each.
"""

import gettext
import re
import sys

FIELD = re.compile(r"(\{[^{}]*\}|%\(\w+\)\w|%\w)")
WIDE = {code: code + 0xFEE0 for code in (*range(0x41, 0x5B), *range(0x61, 0x7B))}
WORD = re.compile(r"(?<![\w#./{@-])[A-Za-z][a-z]{2,}(?![\w./}])")
# Values: what the test names, keys of the keyboard, units, and names of formats and methods.
VALUES = {
    "bar",
    "handle",
    "copy",
    "Ctrl",
    "Shift",
    "Alt",
    "Space",
    "Tab",
    "Esc",
    "Escape",
    "Enter",
    "English",
    "Deutsch",
    "Home",
    "End",
}
VALUES |= {"Delete", "Backspace", "Page", "Down", "Left", "Right", "fps", "eta", "metric"}


def widened(text: str) -> str:
    """Return a text in the pseudo-language; its fields are kept."""
    parts = FIELD.split(text)
    return "".join(
        each if number % 2 else each.translate(WIDE) for number, each in enumerate(parts)
    )


def speak() -> None:
    """Make every text of the catalogue one of the pseudo-language, from here on."""

    def in_plural(one: str, many: str, count: int) -> str:
        return widened(one if count == 1 else many)

    # Of the program, and of argparse.
    none = gettext.NullTranslations
    none.gettext, none.ngettext = lambda _, text: widened(text), lambda _, *forms: in_plural(*forms)
    gettext.gettext, gettext.ngettext = widened, in_plural


def english(text: str) -> list[str]:
    """Return the words of a text that have not been translated."""
    return [word for word in WORD.findall(text.partition("##")[0]) if word not in VALUES]


def unfilled(text: str) -> list[str]:
    """Return the fields of a drawn text; only patterns for the names of files have one."""
    return [field for field in re.findall(r"\{\w*", text) if field != "{name"]


class Reader:
    """Reads what ImGui draws, with all menus, lists, headings and tooltips open at once."""

    TEXTS = (
        *("text", "text_colored", "text_disabled", "text_wrapped", "text_unformatted", "button"),
        *("small_button", "selectable", "checkbox", "radio_button", "menu_item", "set_tooltip"),
        *("menu_item_simple", "collapsing_header", "separator_text", "begin_menu", "begin_combo"),
        *("slider_int", "slider_float", "drag_int", "drag_float", "input_int", "input_float"),
        *("input_text", "input_text_with_hint", "color_edit3", "color_edit4", "tree_node"),
        *("progress_bar", "calc_text_size", "begin_tab_item", "bullet_text", "label_text"),
    )

    def __init__(self) -> None:
        from imgui_bundle import imgui  # noqa: PLC0415 - after the language

        self.left: dict[str, None] = {}
        self.read: set[str] = set()
        self._imgui, self._opened = imgui, []
        for name in self.TEXTS:
            setattr(imgui, name, self._reading(getattr(imgui, name)))
        for begin, end in (("menu", "menu"), ("popup", "popup"), ("combo", "combo")):
            self._keep_open(f"begin_{begin}", f"end_{end}")
        imgui.is_item_hovered = lambda *_: True

    def _reading(self, draw):
        def drawn(*arguments, **options):
            for text in (*arguments, *options.values()):
                if isinstance(text, str):
                    self.read.add(text)
                    self.left.update(
                        dict.fromkeys([text] if english(text) or unfilled(text) else ())
                    )
            return draw(*arguments, **options)

        return drawn

    def _keep_open(self, begin_name, end_name):
        """Draw the contents of what is closed in a child window of its own."""
        imgui, begin, end = (
            self._imgui,
            getattr(self._imgui, begin_name),
            getattr(self._imgui, end_name),
        )

        def opened(name, *arguments, **options):
            is_open = begin(name, *arguments, **options)
            self._opened.append(is_open)
            return is_open or imgui.begin_child(f"open {name} {len(self._opened)}") or True

        def closed():
            end() if self._opened.pop() else imgui.end_child()

        setattr(imgui, begin_name, opened)
        setattr(imgui, end_name, closed)


def read_window(left: dict[str, None]) -> None:
    reader = Reader()
    from bars import bend_bar  # noqa: PLC0415
    from harness import Harness  # noqa: PLC0415
    from imgui_bundle import hello_imgui  # noqa: PLC0415

    from app.editor.layering.layer_list import duplicate_layer  # noqa: PLC0415

    window = Harness()
    window.frames(3)
    bend_bar(window, None, "auto-pins")
    duplicate_layer(window.session, 0)
    window.settle()
    for panel in hello_imgui.get_runner_params().docking_params.dockable_windows:
        panel.focus_window_at_next_frame = True
        window.frames(3)
    assert len(reader.read) > 500, "there is much more to read"
    left.update(reader.left)


def read_table(left: dict[str, None]) -> None:
    from app.ui.shortcuts.table import ACTIONS  # noqa: PLC0415

    for action in ACTIONS.values():
        left.update(dict.fromkeys(each for each in (action.label, action.hint) if english(each)))


def read_help(left: dict[str, None]) -> None:
    from app.cli.main import COMMANDS, build_parser  # noqa: PLC0415
    from app.cli.options import METHODS  # noqa: PLC0415
    from app.export_formats import EXPORT_FORMATS  # noqa: PLC0415

    VALUES.update(EXPORT_FORMATS, *(method.split("-") for method in METHODS))
    for command in COMMANDS:
        parser = build_parser([command])
        actions = list(parser._actions)
        own = actions[-1].choices[command]
        texts = [parser.description, own.description, own.epilog]
        for action in (*actions[:-1], *actions[-1]._choices_actions, *own._actions):
            VALUES.update(action.choices or ())
            texts.append(action.help)
        for text in filter(None, texts):
            # Values are in braces and quotes, and defaults.
            shown = re.sub(r"\{[^{}]*\}|\"[^\"]*\"|%\(\w+\)s", "", text)
            left.update(dict.fromkeys([text] if english(shown) else ()))


if __name__ == "__main__":
    speak()
    found: dict[str, None] = {}
    read_help(found)
    read_window(found)
    read_table(found)
    sys.stdout.write("\n".join(found))
