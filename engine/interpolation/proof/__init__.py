"""Proof of in-betweens: how far they distort, at every time and in the whole domain.

In: the in-betweens of two keyframes.
Out: enclosures of k, σ_a and σ_b, and the times where they are not tight; certificates of single
frames to which a map was added.
Imports: `engine.maps`, `engine.interpolation.enclosing`, `engine.interpolation.inbetweens`.
"""

from engine.interpolation.proof.bisection import Proof as Proof, prove as prove
from engine.interpolation.proof.single_frames import prove_frame as prove_frame
