"""Keyframes sampled along the paths, and proven free of folds."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from engine.arrays import Complexes, Indices, freeze, nbytes_of
from engine.errors import EngineError
from engine.geometry import next_on_loop
from engine.interpolation.sampled_domain import SampledDomain
from engine.maps import HarmonicMap, LocalBounds, certify, distortion
from engine.paths import IntegrationPaths, continue_logarithm

FOLDS = (
    "Keyframe {number} folds: at ({x:.6g}, {y:.6g}) its smaller stretch sigma_b is "
    "{sigma_b:.3g}, and must be clearly above 0. Pose it again within the limits."
)


@dataclass(frozen=True, slots=True, kw_only=True, eq=False)
class KeyframeSamples:
    """One keyframe at the nodes of the integration paths (s,) and at the points (m,).

    The samples depend on the map and the sampled domain only, so each keyframe is sampled once for
    all its segments. ν = conj(f_z̄) / f_z is holomorphic, and therefore conj(η) = ν f_z², too.

    Attributes
    ----------
    log_fz, log_fz_z : complex128, shape (s,)
        log f_z, with the principal value at the anchor, and its derivative f_zz / f_z.
    nu, nu_z : complex128, shape (s,)
        The second dilatation and its derivative.
    anchor_position : complex
        f at the anchor.
    positions : complex128, shape (m,)
        f at the points.
    phi_error, psi_error : complex128, shape (m,)
        Φ and Ψ in closed form, minus their quadrature along the paths.
    """

    map: HarmonicMap
    log_fz: Complexes
    log_fz_z: Complexes
    nu: Complexes
    nu_z: Complexes
    anchor_position: complex
    positions: Complexes
    phi_error: Complexes
    psi_error: Complexes

    @property
    def anchor_fz(self) -> complex:
        return complex(np.exp(self.log_fz[0]))

    def at(self, which: Indices) -> "KeyframeSamples":
        """Return a copy restricted to some of the nodes (c,)."""
        return replace(
            self,
            log_fz=freeze(self.log_fz[which]),
            log_fz_z=freeze(self.log_fz_z[which]),
            nu=freeze(self.nu[which]),
            nu_z=freeze(self.nu_z[which]),
        )

    @property
    def nbytes(self) -> int:
        """Memory of the arrays without the map, in bytes."""
        return nbytes_of(self, but=(self.map,))


def sample_keyframes(
    maps: Sequence[HarmonicMap], sites: SampledDomain
) -> tuple[KeyframeSamples, ...]:
    """Sample maps over the cage of the sampled domain; all maps share one pass over the nodes.

    Raises
    ------
    EngineError
        If a map folds anywhere in the domain, or if a fold cannot be excluded.
    """
    if not maps:
        raise EngineError("There is no keyframe to sample; give at least one.")
    paths = sites.paths
    for i, f in enumerate(maps):
        _require_unfolded(f, sites, i)
    span = sites.boundary.span
    coefficients = np.hstack([f.coefficients for f in maps])
    values, first_order, second_order = span.evaluate(coefficients, paths.nodes, orders=(0, 1, 2))
    # Φ and Ψ themselves change with each turn around a hole: log(z − c) has an argument. The
    # span leaves it out, since it cancels in f.
    ends = np.concatenate([[0], paths.places])
    values = values[ends]
    values.imag += sites.arguments @ coefficients[len(span.vertices) :].real
    values.real -= sites.arguments @ coefficients[len(span.vertices) :].imag
    columns = [slice(2 * i, 2 * i + 2) for i in range(len(maps))]
    return tuple(
        _samples(f, paths, values[:, c], first_order[:, c], second_order[:, c])
        for f, c in zip(maps, columns, strict=True)
    )


def _samples(
    f: HarmonicMap,
    paths: IntegrationPaths,
    values: Complexes,
    first_order: Complexes,
    second_order: Complexes,
) -> KeyframeSamples:
    """Pack the values of one keyframe; the two columns of each array belong to Φ and Ψ."""
    (fz, g), (fzz, gz) = first_order.T, second_order.T
    log_fz_z = fzz / fz
    nu = g / fz
    phi_error, psi_error = (
        exact[1:] - exact[0] - paths.integrals(paths.step_integrals(values_along, derivatives))
        for exact, values_along, derivatives in zip(
            values.T, first_order.T, second_order.T, strict=True
        )
    )
    positions = values[:, 0] + values[:, 1].conj()
    return KeyframeSamples(
        map=f,
        log_fz=freeze(continue_logarithm(fz, log_fz_z, paths, lambda z: f.derivatives(z)[0])),
        log_fz_z=freeze(log_fz_z),
        nu=freeze(nu),
        nu_z=freeze(gz / fz - nu * log_fz_z),
        anchor_position=complex(positions[0]),
        positions=freeze(positions[1:]),
        phi_error=freeze(phi_error),
        psi_error=freeze(psi_error),
    )


def _require_unfolded(f: HarmonicMap, sites: SampledDomain, number: int) -> None:
    """Raise if a keyframe is not proven to be locally injective in the whole domain."""
    certificate = certify(f, sites.boundary, LocalBounds(k=1.0, sigma_a=np.inf, sigma_b=0.0))
    if certificate.is_certified:
        return
    fz, fzbar = f.derivatives(sites.boundary.points)
    sigma_b = distortion.sigma_b(fz, fzbar)
    worst = int(sigma_b.argmin())
    if sigma_b[worst] <= 0 or certificate.winding == 0:
        z = sites.boundary.points[worst]
        raise EngineError(FOLDS, number=number, x=z.real, y=z.imag, sigma_b=sigma_b[worst])
    for hole, turns in enumerate(_turns(fz, sites), start=1):
        if turns:
            raise EngineError(
                "Keyframe {number} turns the drawing inside out around hole {hole} of {count}. "
                "Along the hole's edge f_z winds {turns} times around 0, and must not wind. No "
                "motion without folds leads to this keyframe. Pose it again from the drawing at "
                "rest, by small steps.",
                number=number,
                hole=hole,
                count=len(sites.loops.starts),
                turns=turns,
            )
    # By the argument principle, f_z has as many zeros inside as it winds around 0.
    nodes = sites.paths.nodes
    z = nodes[np.abs(f.derivatives(nodes)[0]).argmin()]
    raise EngineError(
        "Keyframe {number} folds inside: f_z winds {winding} times around 0 along the outline "
        "and vanishes near ({x:.6g}, {y:.6g}). Pose it again within the limits.",
        number=number,
        winding=certificate.winding,
        x=z.real,
        y=z.imag,
    )


def _turns(fz: Complexes, sites: SampledDomain) -> Indices:
    """Return the winding number of f_z around 0 along each hole, from the boundary samples."""
    starts = sites.boundary.starts
    following = next_on_loop(starts, len(fz))
    angles = np.angle(fz[following] / fz)
    around = np.add.reduceat(angles, starts)[1:] / (2 * np.pi)
    return np.round(around).astype(np.intp)
