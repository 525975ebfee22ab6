"""Whether an export carries the sounds."""

from dataclasses import replace

from app.document import Document, ExportSettings
from app.export_formats import EXPORT_FORMATS
from app.texts import _
from app.ui.style.theme import Look
from app.ui.style.widgets import label, option_buttons, small_text

OPTIONS = (("all", _("All")), ("none", _("None")))


def draw_sound_option(look: Look, document: Document, settings: ExportSettings) -> ExportSettings:
    """Draw the choice if the document has sounds. Return the changed settings."""
    format_ = EXPORT_FORMATS[settings.format]
    if not document.sounds or format_.is_still:
        return settings
    if not format_.has_sound:
        small_text(look, _("{format} has no sound.").format(format=format_.label))
        return settings
    label(look, _("Sounds"))
    chosen = option_buttons(look, "sounds", OPTIONS, "all" if settings.sound else "none")
    return settings if chosen is None else replace(settings, sound=chosen == "all")
