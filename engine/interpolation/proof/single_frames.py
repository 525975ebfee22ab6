"""Proof of one in-between with a map of the span added to it: of a frame that was corrected.

f_z and conj(f_z̄) are holomorphic for every variant, and so they are with a map added. Along a piece
of the boundary it is known what is blended of the keyframes, and from it how far both are off their
chords (`engine.interpolation.enclosing`). All else is as for a map (`engine.maps.certificate`), the
winding of f_z included, which what is added might bring about.

The metric variant has f_z from |f_z| by a Hilbert transform; nothing bounds what its argument does
between two points of the boundary, and nothing is proven of its frames.
"""

from dataclasses import dataclass
from typing import Self

import numpy as np

from engine.arrays import Booleans, Complexes, Floats, Indices
from engine.errors import EngineError
from engine.interpolation.enclosing import Chord, Subdivision
from engine.interpolation.inbetweens import Inbetweens
from engine.interpolation.proof.correction import Correction, closing_on
from engine.maps import Certificate, Limits, certify_pieces


def prove_frame(
    inbetweens: Inbetweens,
    time: float,
    added: Complexes,
    limits: Limits,
) -> Certificate | None:
    """Bound the distortion of f + g in the whole domain, f an in-between and g a map.

    Parameters
    ----------
    inbetweens : Inbetweens
        Whose points begin with the samples of their boundary.
    time : float
        In [0, 1].
    added : complex128, shape (n, 2)
        The coefficients of g, as `HarmonicMap.coefficients` has them.
    limits : Limits
        What it is tested for.

    Returns
    -------
    Certificate or None
        None where the variant allows no proof.

    Raises
    ------
    EngineError
        If the points do not begin with the samples.
    """
    blend = inbetweens.blend
    if not blend.is_closed_form or (inbetweens.pins is not None and not blend.sign):
        return None
    boundary, sites = inbetweens.boundary, inbetweens.sites
    count = len(boundary.points)
    if not np.array_equal(sites.points[:count], boundary.points):
        raise EngineError("A frame is proven with the in-betweens of its boundary's samples.")
    with np.errstate(all="ignore"):
        own = blend.at(sites.paths.places[:count]).derivatives(time)
        motion = _Motion.of(inbetweens, time, added)
        pieces = _FramePieces.of(motion, np.arange(count), own.fz, np.arange(count))
        return certify_pieces(pieces, boundary, limits)


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class _Motion:
    """f_z and conj(f_z̄) of a frame, along any pieces of the boundary.

    Parameters
    ----------
    inbetweens : Inbetweens
    time : float
    pieces : Subdivision
        Of the keyframes and, last, of what is added.
    h, d : Correction or None
        What closes periods around holes.
    pins : tuple of Correction
        h and q of handles that stay; none where there are none.
    """

    inbetweens: Inbetweens
    time: float
    pieces: Subdivision
    h: Correction | None
    d: Correction | None
    pins: tuple[Correction, ...]

    @classmethod
    def of(cls, inbetweens: Inbetweens, time: float, added: Complexes) -> Self:
        """Begin with the segments of the boundary."""
        blend, boundary = inbetweens.blend, inbetweens.boundary
        coefficients = [key.map.coefficients for key in blend.passage.keyframes]
        pieces = Subdivision.of([*coefficients, added], boundary)
        h, d = (
            None if closing is None else closing_on(closing, boundary, pieces, lost)
            for closing, lost in (
                (inbetweens.closing, blend.constants),
                (inbetweens.conformal_closing, None),
            )
        )
        known = None if inbetweens.pins is None else inbetweens.pins.pins
        pins = () if known is None else (known.h, known.q)
        return cls(
            inbetweens=inbetweens,
            time=time,
            pieces=pieces,
            h=h,
            d=d,
            pins=tuple(Correction(each, known.series, boundary, pieces) for each in pins if known),
        )

    def along(self, which: Indices, start: Complexes) -> tuple[Chord, Chord, Complexes]:
        """Return f_z and conj(f_z̄) along pieces, and f_z of the blend alone at their ends.

        `start` is the latter where they begin.
        """
        blend, values = self.inbetweens.blend, self.pieces.derivatives(0)
        keyframes = values.of(which, slice(None, -1))
        change = Chord.of(keyframes.log_change(), blend.passage.course(self.time))
        closing = self._corrected(self.h, which)
        if closing is not None:
            # What is blended is known where pieces begin: there the change is none.
            first = closing.first
            change = change.plus(closing._replace(first=0 * first, last=closing.last - first))
        fz, g = blend.chords(keyframes, self.time, start, change)
        end, rho = fz.last, self.inbetweens.rho(self.time)
        # K = L² / F, L the exponential of the keyframes' blended logarithms.
        k = fz if closing is None else fz.product(closing.times(-2.0).exponential())
        g, d = g.times(rho), self._corrected(self.d, which)
        if d is not None:
            share = d.exponential().times(1.0 - rho)
            share = share._replace(first=rho + share.first, last=rho + share.last)
            fz, k = fz.product(share), k.product(share.reciprocal())
        if self.pins:
            h, q = (self._at_time(each, which) for each in self.pins)
            grown = h.exponential()
            own = grown if blend.sign > 0 else h.times(-1.0).exponential()
            fz, g = fz.product(grown), g.product(own).plus(q.product(k).product(grown))
        added = values.of(which, slice(-1, None))
        return (
            fz.plus(Chord.of(added.conformal(), np.ones(1))),
            g.plus(Chord.of(added.anticonformal(), np.ones(1))),
            end,
        )

    def _corrected(self, correction: Correction | None, which: Indices) -> Chord | None:
        return None if correction is None else self._at_time(correction, which)

    def _at_time(self, correction: Correction, which: Indices) -> Chord:
        now = np.full(len(which), self.time)
        patch, _ = correction.on(which, now, now)
        return Chord(patch.controls[:, 0, 0], patch.controls[:, 0, -1], patch.error)


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class _FramePieces:
    """Pieces of the boundary with a frame's derivatives, as `certify_pieces` takes them.

    `which` are their numbers in the motion's subdivision, and `start` is f_z of the blend alone
    where they begin.
    """

    motion: _Motion
    which: Indices
    start: Complexes
    ends: Complexes
    errors: Floats
    origins: Indices

    @classmethod
    def of(cls, motion: _Motion, which: Indices, start: Complexes, origins: Indices) -> Self:
        """Work pieces out."""
        fz, g, _ = motion.along(which, start)
        return cls(
            motion=motion,
            which=which,
            start=start,
            ends=np.array([[fz.first, fz.last], [g.first, g.last]]),
            errors=np.array([fz.error, g.error]),
            origins=origins,
        )

    def divided(self, which: Booleans, /) -> tuple[Self, int]:
        """Return the halves of some of the pieces, and their number."""
        motion, start, origins = self.motion, self.start[which], self.origins[which]
        motion.pieces.halve(self.which[which])
        first = motion.pieces.halves[self.which[which]]
        _, _, middle = motion.along(first, start)
        halves, starts = np.append(first, first + 1), np.append(start, middle)
        return self.of(motion, halves, starts, np.append(origins, origins)), 2
