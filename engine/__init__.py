"""Harmonic shape interpolation: pure numerics, free of files, windows and global state.

The one exception: it limits BLAS to one thread (`engine.arrays`), in a script as in the program.

In: masks, polygons, handles, harmonic maps, as arrays.
Out: domains, certified maps, in-betweens, series in time, as arrays.
Imports: NumPy, SciPy, contourpy, Shapely; never `app`.

`engine.face` lists the names that a script needs, `engine/examples` has scripts, and
`engine.reference` has the paper's variants as printed.

Equation map of *Bounded Distortion Harmonic Shape Interpolation* (Chien, Chen, Weber 2016):

    (1)             f = Φ + conj(Ψ)                engine.maps.harmonic_map.HarmonicMap
    (14)            Cauchy coordinates             engine.maps.cauchy.cauchy_coordinates
    Section 3.4     μ, first dilatation            engine.maps.distortion.mu
    Section 3.4     k, little dilatation           engine.maps.distortion.k
    Section 3.4     K, large dilatation            engine.maps.distortion.K
    Section 3.4     σ_a, larger singular value     engine.maps.distortion.sigma_a
    Section 3.4     σ_b, smaller singular value    engine.maps.distortion.sigma_b
    Section 5.2     ν, second dilatation           engine.maps.distortion.nu
    Section 5.4     η                              engine.maps.distortion.eta
    Section 8       τ, isometric distortion        engine.maps.distortion.tau
    (2), (15)       continuous logarithm           engine.paths.complex_log.continue_logarithm
    Section 7.2     branch at the anchor           engine.paths.complex_log.root_sheets
    Section 4.1     harmonic in-betweens           engine.interpolation.inbetweens.Inbetweens
    (3)             logarithmic blend of f_z       engine.interpolation.keyframe_blend.derivatives.KeyframeBlend
    (4), (5)        ν variant                      engine.interpolation.blends.nu.NuBlend
    (6), (7)        η variant                      engine.interpolation.blends.eta.EtaBlend
    (8)             scaled η variant               engine.interpolation.inbetweens.Inbetweens
    (16)            ρ within k at a point          engine.interpolation.scaling.pointwise.largest_rho
    (17)            ρ within σ_a                   engine.interpolation.scaling.pointwise.largest_rho
    (18)            ρ within σ_b                   engine.interpolation.scaling.pointwise.largest_rho
    Section 7.3     largest ρ(t) of the outline    engine.interpolation.scaling.exact_rho.ExactRho
    Property 4      ρ(t) without kinks             engine.interpolation.scaling.smoothed_rho.SmoothedRho
    (9), (13)       metric on the outline          engine.interpolation.blends.outline.OutlineMetric
    (10), (11)      σ_a, σ_b of the metric         engine.interpolation.blends.outline.OutlineMetric
    (12)            K of the metric, Lemma 7       engine.interpolation.blends.outline.OutlineMetric
    Section 6       metric variant                 engine.interpolation.blends.metric.MetricBlend
    Section 7.4     Hilbert transform              engine.dirichlet.hilbert.HilbertTransform
    Section 7       spanning tree from the anchor  engine.paths.spanning_tree.SpanningTree
    Section 7       quadrature along its edges     engine.paths.integration_paths.IntegrationPaths
    Figure 7        harmonic coordinates           app.motion.rival_methods.boundary_keyframes.harmonic_coordinate_maps
    Section 8       ARAP (Alexa et al. 2000)       app.motion.rival_methods.arap.ArapInbetweens
    Section 8       FFMP (Kircher, Garland 2008)   app.motion.rival_methods.ffmp.FfmpInbetweens
    Section 8       Chen et al. 2013               app.motion.rival_methods.blended_metric.FlatInbetweens
    Section 9.1     scaled η on meshes             app.motion.rival_methods.mesh_eta.MeshEtaInbetweens

The deformer follows Chen and Weber, *Bounded Distortion Harmonic Mappings in the Plane* (2015) and
*GPU-Accelerated Locally Injective Shape Deformation* (2017):

    2015            bounds k, σ_a, σ_b               engine.maps.bounds.Bounds
    2015, Th. 4     certificate in the whole domain  engine.maps.certificate.certify
    2017            symmetric Dirichlet energy       engine.deform.model.energy.symmetric_dirichlet
    2017            Newton step, projected Hessian   engine.deform.model.newton.newton_direction
"""

from importlib import import_module
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from engine.face import *  # noqa: F403


def __getattr__(name: str) -> object:
    """Load the face, and with it the rooms, at the first use of a name from it.

    An import of `engine.variant` or `engine.errors` alone does not load NumPy.
    """
    if name.startswith("_"):
        raise AttributeError(name)
    face = import_module("engine.face")
    return globals()[name] if name in globals() else getattr(face, name)


def __dir__() -> list[str]:
    return [name for name in dir(import_module("engine.face")) if not name.startswith("_")]
