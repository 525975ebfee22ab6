"""What the program says, asserted by its own constants and not by their wording."""

import re
from string import Formatter


def says(message: str, **values: object) -> str:
    """Return a regular expression for a message with these values in its fields.

    A field that has no value matches anything.
    """
    known = Formatter()
    parts = []
    for text, field, form, conversion in known.parse(message):
        parts.append(re.escape(text))
        if field is not None and field in values:
            value = known.convert_field(values.pop(field), conversion)
            parts.append(re.escape(known.format_field(value, form or "")))
        elif field is not None:
            parts.append(".*")
    assert not values, f"the message has no fields {', '.join(values)}"
    return "".join(parts)
