"""The project that is open: its document, what the window has of it, and what is under way."""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from math import inf
from pathlib import Path
from typing import Self

from app.document import (
    Clip,
    Document,
    Figure,
    History,
    Keyframe,
    Meshing,
    PictureFile,
