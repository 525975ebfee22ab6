"""Texts for the person, which all come from one catalogue: `_("Undo")`.

In: English texts, which are the catalogue's keys (`app/locale/lissom.pot`).
Out: the texts in the person's language, if a translation is installed, else in English.

The language is chosen when the program starts, so tables may hold translated texts. A text that is
also a name in files, or that the engine wrote, is marked by `N_` or by its class, and translated
where it is shown.
"""

import gettext
from pathlib import Path
from typing import cast

from engine.errors import EngineError, Message

DOMAIN, LOCALE = "lissom", Path(__file__).parent / "locale"
# Also for `argparse`, which takes its own texts from the usual catalogue.
gettext.bindtextdomain(DOMAIN, str(LOCALE))
gettext.textdomain(DOMAIN)
# `gettext.gettext` would search for the catalogue's file at each call.
_translation = gettext.translation(DOMAIN, str(LOCALE), fallback=True)
_ = _translation.gettext
ngettext = _translation.ngettext


def N_(text: str) -> str:  # noqa: N802 - gettext's own name
    """Mark a text that is translated where it is shown."""
    return text


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
