"""Keyframes: harmonic maps of one domain, checked, and sampled where the in-betweens need them."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from engine.arrays import Complexes, readonly
from engine.errors import EngineError
from engine.maps import HarmonicMap, evaluate
from engine.paths import IntegrationPaths, continue_logarithm


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class KeyframeSamples:
    """One keyframe at the nodes of the integration paths (s,) and at the points (m,).

    It depends on the map and the paths only, so that each keyframe is sampled once, whatever its
    neighbours are. ν = conj(f_z̄) / f_z is holomorphic, and conj(η) = ν f_z² with it.

    Parameters
    ----------
    map : HarmonicMap
    log_fz, log_fz_slope : complex128, shape (s,)
        log f_z, the principal value at the anchor, and its derivative f_zz / f_z.
    nu, nu_slope : complex128, shape (s,)
        The second dilatation and its derivative.
    anchor_position : complex
        f at the anchor.
    positions : complex128, shape (m,)
        f at the points.
    phi_error, psi_error : complex128, shape (m,)
        What the quadrature along the paths lacks of Φ and Ψ, which a keyframe has in closed form.
    outline_fz, outline_g : complex128, shape (r,)
        f_z and conj(f_z̄) at the samples of the outline.
    """

    map: HarmonicMap
    log_fz: Complexes
    log_fz_slope: Complexes
    nu: Complexes
    nu_slope: Complexes
    anchor_position: complex
    positions: Complexes
    phi_error: Complexes
    psi_error: Complexes
    outline_fz: Complexes
    outline_g: Complexes

    @property
    def anchor_fz(self) -> complex:
        """f_z at the anchor."""
        return complex(np.exp(self.log_fz[0]))

    @property
    def nbytes(self) -> int:
        """Memory that the arrays take, in bytes."""
        at_nodes = (self.log_fz, self.log_fz_slope, self.nu, self.nu_slope)
        at_points = (self.positions, self.phi_error, self.psi_error)
        return sum(a.nbytes for a in (*at_nodes, *at_points, self.outline_fz, self.outline_g))


def sample_keyframes(
    maps: Sequence[HarmonicMap],
    paths: IntegrationPaths,
    outline: Complexes,
    *,
    first: int = 0,
) -> tuple[KeyframeSamples, ...]:
    """Sample maps over one cage; one pass over the nodes' logarithms serves all of them.

    Parameters
    ----------
    maps : sequence of HarmonicMap
        Maps over the same cage.
    paths : IntegrationPaths
    outline : complex128, shape (r,)
        Samples in order along the outline.
    first : int
        Number of the first map among the keyframes, for the errors.

    Raises
    ------
    EngineError
        If a map folds anywhere on the outline or at a node, or f_z has a zero inside.
    """
    cage = maps[0].cage
    coefficients = np.column_stack([c for f in maps for c in (f.phi, f.psi)])
    (on_outline,) = evaluate(cage, coefficients, outline, orders=(1,))
    slopes, bends = evaluate(cage, coefficients, paths.nodes, orders=(1, 2))
    ends = np.concatenate([paths.nodes[:1], paths.nodes[paths.places]])
    (values,) = evaluate(cage, coefficients, ends, orders=(0,))
    _require_unfolded(on_outline, outline, first)
    _require_unfolded(slopes, paths.nodes, first)
    _require_no_winding(on_outline[:, 0::2], slopes[:, 0::2], paths.nodes, first)
    columns = [slice(2 * i, 2 * i + 2) for i in range(len(maps))]
    return tuple(
        _samples(f, paths, slopes[:, c], bends[:, c], values=values[:, c], outline=on_outline[:, c])
        for f, c in zip(maps, columns, strict=True)
    )


def _samples(
    f: HarmonicMap,
    paths: IntegrationPaths,
    slopes: Complexes,
    bends: Complexes,
    *,
    values: Complexes,
    outline: Complexes,
) -> KeyframeSamples:
    """Pack what was evaluated of one keyframe; the two columns of each array are of Φ and Ψ."""
    (fz, g), (fz_slope, g_slope) = slopes.T, bends.T
    log_fz_slope = fz_slope / fz
    nu = g / fz
    phi_error, psi_error = (
        exact[1:] - exact[0] - paths.integrals(paths.step_integrals(slope, bend))
        for exact, slope, bend in zip(values.T, slopes.T, bends.T, strict=True)
    )
    positions = values[:, 0] + values[:, 1].conj()
    return KeyframeSamples(
        map=f,
        log_fz=readonly(continue_logarithm(fz, paths, lambda z: f.derivatives(z)[0])),
        log_fz_slope=readonly(log_fz_slope),
        nu=readonly(nu),
        nu_slope=readonly(g_slope / fz - nu * log_fz_slope),
        anchor_position=complex(positions[0]),
        positions=readonly(positions[1:]),
        phi_error=readonly(phi_error),
        psi_error=readonly(psi_error),
        outline_fz=readonly(outline[:, 0]),
        outline_g=readonly(outline[:, 1]),
    )


def _require_unfolded(slopes: Complexes, points: Complexes, first: int) -> None:
    """Refuse keyframes that fold at one of the points; columns are Φ' and Ψ' of each in turn."""
    sigma_b = np.abs(slopes[:, 0::2]) - np.abs(slopes[:, 1::2])
    for i, at in enumerate(sigma_b.argmin(axis=0)):
        if sigma_b[at, i] <= 0:
            z = points[at]
            raise EngineError(
                f"Keyframe {first + i} folds: at ({z.real:.6g}, {z.imag:.6g}) its smaller stretch "
                f"sigma_b is {sigma_b[at, i]:.3g}, and must be above 0. Pose it again within "
                "bounds."
            )


def _require_no_winding(
    on_outline: Complexes, inside: Complexes, nodes: Complexes, first: int
) -> None:
    """Refuse keyframes whose f_z has zeros inside: by the argument principle, it winds around 0."""
    turns = np.angle(np.roll(on_outline, -1, axis=0) / on_outline).sum(axis=0) / (2 * np.pi)
    for i, zeros in enumerate(np.round(turns).astype(int)):
        if zeros:
            z = nodes[np.abs(inside[:, i]).argmin()]
            raise EngineError(
                f"Keyframe {first + i} folds inside: f_z winds {zeros} times around 0 along the "
                f"outline and vanishes near ({z.real:.6g}, {z.imag:.6g}). Pose it again within "
                "bounds."
            )
