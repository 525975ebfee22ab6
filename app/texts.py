"""Texts for the person, which all come from one catalogue: `_("Undo")`.

In: English texts, which are the catalogue's keys (`app/locale/lissom.pot`), and a file for each
other language (`app/locale/de.po`).
Out: the texts in the person's language, where it has them, else in English.

The language is chosen when the program starts, so tables may hold translated texts. A text that is
also a name in files, or that the engine wrote, is marked by `N_` or by its class, and translated
where it is shown.
"""

import ctypes
import gettext
import json
import locale
import os
import re
import sys
from collections.abc import Callable
from contextlib import suppress
from functools import cache
from pathlib import Path
from typing import cast

from app.folders import preferences_file
from engine.errors import EngineError, Message

DOMAIN, LOCALE = "lissom", Path(__file__).parent / "locale"
# In place of the preferences and the system, such as "de".
CHOICE = "LISSOM_LANGUAGE"
ENGLISH = "en"
# Texts of a file of translations, each of which may go over several lines.
_STRINGS = r'((?:".*"\n)+)'
_ENTRY = re.compile(
    rf"^msgid {_STRINGS}(?:msgid_plural {_STRINGS})?((?:msgstr(?:\[\d\])? (?:\".*\"\n)+)+)",
    re.MULTILINE,
)
_FORM = re.compile(rf"msgstr(?:\[\d\])? {_STRINGS}")
_ESCAPE = re.compile(r"\\(.)")
_ESCAPED = {"n": "\n", "t": "\t"}


def _unquoted(strings: str) -> str:
    text = strings[1:-2].replace('"\n"', "")
    if "\\" not in text:
        return text
    return _ESCAPE.sub(lambda found: _ESCAPED.get(found[1], found[1]), text)


def read_translations(path: Path) -> dict[str, tuple[str, ...]]:
    """Return the texts of a `.po` file by the English ones, each with its plural forms.

    Texts that are not translated yet are left out. The header is the text of "".
    """
    return parse_translations(path.read_text(encoding="utf-8"))


def parse_translations(text: str) -> dict[str, tuple[str, ...]]:
    """Return the texts of the content of a `.po` file, as `read_translations` does."""
    translations = {}
    for one, many, strings in _ENTRY.findall(text if text.endswith("\n") else text + "\n"):
        forms = _FORM.findall(strings) if many else [strings[7:]]  # behind "msgstr "
        translated = tuple(map(_unquoted, forms))
        if all(translated):
            translations[_unquoted(one)] = translated
    return translations


@cache
def list_languages() -> dict[str, str]:
    """Return the languages that Lissom speaks: what each calls itself, by code, English first."""
    found = {ENGLISH: "English"}
    for path in sorted(LOCALE.glob("*.po")):
        with path.open(encoding="utf-8", errors="replace") as file:
            name = re.search(r"X-Language-Name: (.*?)\\n", file.read(2_000))
        found[path.stem] = name[1] if name else path.stem
    return found


class _Translations(gettext.NullTranslations):
    """The texts of a language. A text that it lacks stays English."""

    def __init__(self, path: Path) -> None:
        super().__init__()
        self._texts = read_translations(path)
        (header,) = self._texts.pop("", ("",))
        rule = re.search(r"plural=([^;\n]*)", header)
        self._form: Callable[[int], int] = gettext.c2py(rule[1] if rule else "n != 1")

    def gettext(self, message: str) -> str:
        forms = self._texts.get(message)
        return (forms and forms[0]) or message

    def ngettext(self, msgid1: str, msgid2: str, n: int) -> str:
        forms = self._texts.get(msgid1)
        form = self._form(n)
        return forms[form] if forms and form < len(forms) else (msgid1 if n == 1 else msgid2)

    def source_of(self, text: str) -> str:
        return next((one for one, forms in self._texts.items() if forms[0] == text), text)


def _chosen_languages() -> list[str]:
    """Return the codes of the languages that the person wants, the most wanted first."""
    if os.environ.get(CHOICE):
        return [os.environ[CHOICE]]
    try:
        preferences = json.loads(preferences_file().read_bytes())
        chosen = preferences.get("language")
    except (OSError, ValueError, AttributeError, RecursionError):
        chosen = None
    return [chosen] if chosen and isinstance(chosen, str) else read_system_languages()


def read_system_languages() -> list[str]:
    """Return the codes of the system's languages, such as "de_AT", the most wanted first."""
    names = ("LC_ALL", "LC_MESSAGES", "LANG")
    spoken = next((value for name in names if (value := os.environ.get(name))), "")
    if spoken.partition(".")[0] in {"C", "POSIX"}:
        return []
    listed = [*os.environ.get("LANGUAGE", "").split(":"), spoken]
    if not any(listed):
        # Programs that are not started from a terminal have none of these variables there.
        if sys.platform == "win32":
            spoken_there = ctypes.windll.kernel32.GetUserDefaultUILanguage()
            listed = [locale.windows_locale.get(spoken_there, "")]
        elif sys.platform == "darwin":
            listed = [_mac_language()]
    codes = (re.split("[.@]", each)[0].replace("-", "_") for each in listed)
    return [code for code in codes if code]


def _mac_language() -> str:
    """Return the first of the languages in the system's settings, such as "de-AT"."""
    try:
        core = ctypes.CDLL("/System/Library/Frameworks/CoreFoundation.framework/CoreFoundation")
    except OSError:
        return ""
    core.CFLocaleCopyPreferredLanguages.restype = ctypes.c_void_p
    core.CFArrayGetCount.argtypes = [ctypes.c_void_p]
    core.CFArrayGetCount.restype = ctypes.c_long
    core.CFArrayGetValueAtIndex.argtypes = [ctypes.c_void_p, ctypes.c_long]
    core.CFArrayGetValueAtIndex.restype = ctypes.c_void_p
    core.CFStringGetCString.argtypes = [
        *(ctypes.c_void_p, ctypes.c_char_p, ctypes.c_long, ctypes.c_uint32),
    ]
    codes, buffer = core.CFLocaleCopyPreferredLanguages(), ctypes.create_string_buffer(64)
    if not codes or core.CFArrayGetCount(codes) == 0:
        return ""
    utf_8 = 0x08000100
    core.CFStringGetCString(core.CFArrayGetValueAtIndex(codes, 0), buffer, len(buffer), utf_8)
    return buffer.value.decode()


def _translations() -> gettext.NullTranslations:
    """Return the texts of the first wanted language that is English or has a file."""
    for code in _chosen_languages():
        for name in dict.fromkeys((code, code.partition("_")[0])):
            if name == ENGLISH:
                return gettext.NullTranslations()
            path = LOCALE / f"{name}.po"
            if re.fullmatch(r"\w+", name) and path.is_file():
                # A file that a person is writing may be damaged.
                with suppress(OSError, ValueError):
                    return _Translations(path)
    return gettext.NullTranslations()


_translation = _translations()
_ = _translation.gettext
ngettext = _translation.ngettext


def N_(text: str) -> str:  # noqa: N802 - gettext's own name
    """Mark a text that is translated where it is shown."""
    return text


def source_text(text: str) -> str:
    """Return the English text of a translated one, a name that is the same in all languages."""
    return _translation.source_of(text) if isinstance(_translation, _Translations) else text


def message_of(said: Exception | Message | str) -> str:
    """Return the message of an error or notice in the person's language."""
    if not isinstance(said, (EngineError, Message)) or not said.template:
        return str(said)
    # Words among the values, such as "outline", are in the catalogue too.
    values = {
        name: _(value) if isinstance(value, str) and value else value
        for name, value in said.values.items()
    }
    template = _(said.template)
    if isinstance(said, Message) and said.plural:
        template = ngettext(said.template, said.plural, cast("int", said.values["count"]))
    return template.format(**values) if values else template
