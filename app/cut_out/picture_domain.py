"""From a picture to the domain of its subject, and to what the domain's mesh shows."""

from app.cut_out.cut_out import CutOut
from app.cut_out.mask import Subject, subject_mask
from app.cut_out.matte import matte_picture
from app.texts import message_of
from engine.arrays import Bytes
from engine.domain import MeshedDomain, build_domain
from engine.domain.outline.enclosure import Detail


def build_picture_domain(
    rgba: Bytes, *, triangles: int, detail: Detail, cut_out: CutOut | None = None
) -> tuple[MeshedDomain, tuple[str, ...]]:
    """Cut the subject out of a picture (h, w, 4), and build its domain as `build_domain` does.

    Without a `cut_out` it is `CutOut()`. The notices are all remedies that were applied, in words.
    Raises `EngineError` if the picture has no subject that can be outlined.
    """
    cut_out = cut_out or CutOut()
    subject = subject_mask(rgba, cut_out)
    domain, notices = build_domain(
        subject.mask,
        triangles=triangles,
        detail=detail,
        holes=cut_out.holes,
        toggled_holes=subject.toggled_holes,
        cut_lines=[line.points for line in cut_out.cut_lines],
    )
    return domain, subject.notices + tuple(map(message_of, notices))


def texture(rgba: Bytes, subject: Subject) -> Bytes:
    """Return the picture (h, w, 4) of a subject as its domain's mesh shows it.

    The picture keeps its own transparency. The removed background is transparent, and edges are
    free of its colour.
    """
    return matte_picture(rgba, subject.mask) if subject.cut else rgba
