"""Cue files: which mouth is seen from which moment of a sound on.

Rhubarb's TSV, XML and JSON, the DAT files of Papagayo, Moho and Rhubarb, and lines of seconds and a
name, parted by commas, semicolons or tabs.
"""

import json
import re
from collections.abc import Iterable, Iterator
from math import isfinite
from typing import Final

from app.document import Cue
from app.errors import LissomError, shortened
from app.texts import N_, _

CUE_SUFFIXES: Final = (".tsv", ".xml", ".json", ".dat", ".csv", ".txt")
LARGEST_CUES: Final = 16 * 1024 * 1024  # bytes
MOST_CUES: Final = 200_000
LONGEST_NAME: Final = 100  # characters
NO_CUES = N_(
    "{name} holds no cues. Lissom reads TSV, XML and JSON of Rhubarb, DAT of Papagayo and Moho, "
    "and CSV lines of seconds and a name"
)
NOT_CUE = N_("{name}: {content} is not the time and the name of a cue")
# The first line of a DAT file, and a cue of Rhubarb's XML.
_DAT: Final = re.compile(r"\s*MohoSwitch1\s*\n")
_XML: Final = re.compile(r"<mouthCue\b[^>]*?\bstart=[\"']([^\"']*)[\"'][^>]*>([^<]*)</mouthCue>")
_PARTS: Final = re.compile(r"[,;\t]|\s+")


def parse_cues(data: bytes, name: str, fps: float) -> tuple[Cue, ...]:
    """Return the cues of a file, in the order of their times.

    `fps` is the rate of DAT files, whose times are frames from 1 on. Raises `LissomError` for other
    files.
    """
    try:
        text = data.decode("utf-8-sig")
    except UnicodeDecodeError:
        raise LissomError(_(NO_CUES).format(name=name)) from None
    found: Iterable[tuple[object, object]]
    if text.lstrip().startswith("{"):
        found = _of_json(text, name)
    elif text.lstrip().startswith("<"):
        found = _XML.findall(text)
    elif _DAT.match(text):
        lines = _of_lines(text.partition("\n")[2], name)
        found = ((_seconds_of_frame(frame, fps), cue) for frame, cue in lines)
    else:
        found = _of_lines(text, name)
    cues = [_cue(time, cue, name) for time, cue in found]
    if not cues:
        raise LissomError(_(NO_CUES).format(name=name))
    if len(cues) > MOST_CUES:
        text = _("{name} has {count:,} cues; Lissom reads at most {most:,}")
        raise LissomError(text.format(name=name, count=len(cues), most=MOST_CUES))
    return tuple(sorted(cues, key=lambda cue: cue.seconds))


def _of_json(text: str, name: str) -> Iterator[tuple[object, object]]:
    try:
        content = json.loads(text)
    except (ValueError, RecursionError):
        raise LissomError(_(NO_CUES).format(name=name)) from None
    cues = content.get("mouthCues")
    for each in cues if isinstance(cues, list) else ():
        if not isinstance(each, dict):
            raise LissomError(_(NOT_CUE).format(name=name, content=shortened(each)))
        yield each.get("start"), each.get("value")


def _of_lines(text: str, name: str) -> Iterator[tuple[object, object]]:
    """Yield the first two words of each line; a first line without a number is a heading."""
    lines = [line.strip() for line in text.splitlines() if line.strip()]
    for index, line in enumerate(lines):
        time, *rest = [part.strip().strip('"') for part in _PARTS.split(line, maxsplit=1)]
        cue = re.split(r"[,;\t]", rest[0])[0].strip().strip('"') if rest else ""
        is_number = _number(time) is not None
        if is_number or index:
            if not (is_number and cue):
                no_cue = NO_CUES if len(lines) == 1 or not index else NOT_CUE
                raise LissomError(_(no_cue).format(name=name, content=repr(shortened(line))))
            yield time, cue


def _seconds_of_frame(frame: object, fps: float) -> float | None:
    number = _number(frame)
    return None if number is None else (number - 1) / fps


def _number(content: object) -> float | None:
    if isinstance(content, bool) or not isinstance(content, (int, float, str)):
        return None
    try:
        number = float(content)
    except (ValueError, OverflowError):
        return None
    return number if isfinite(number) else None


def _cue(time: object, cue: object, name: str) -> Cue:
    seconds = _number(time)
    word = cue.strip() if isinstance(cue, str) else ""
    if seconds is None or not word or len(word) > LONGEST_NAME:
        content = f"{shortened(time)} {shortened(cue)}"
        raise LissomError(_(NOT_CUE).format(name=name, content=repr(content)))
    return Cue(seconds=seconds, name=word)
