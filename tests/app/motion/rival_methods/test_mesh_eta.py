"""Scaled η in each triangle, as in the paper's Figure 11."""

import numpy as np
import pytest
from interpolation_shapes import bar
from meshed_shapes import k_of, meshed_bar
from numpy.testing import assert_allclose

from app.motion import prepare_baseline
from engine.maps import HarmonicMap

MESH = meshed_bar()


def grown():
    """|f_z| grows by more than the root of e to the right, as in the paper's Figure 4."""
    _, cage = bar(0.25)
    phi = 2 * np.exp(0.5 * cage + 1)
    return [HarmonicMap.identity(cage), HarmonicMap(cage=cage, phi=phi, psi=0.4 * phi)]


def test_scaling_holds_the_conformal_distortion_that_plain_eta_would_exceed():
    between = prepare_baseline("mesh-eta", grown(), MESH.vertices, MESH.triangles)
    domain = between.domain
    most = k_of(*domain.derivatives(grown()[1](MESH.vertices)))
    for time in (0.25, 0.5, 0.75):
        frame = between.frame(time)
        assert 0 < frame.rho < 0.95
        k = k_of(frame.fz, frame.fzbar)
        # The Poisson step adds as much as the mesh is coarse.
        assert (k / most).max() < 1 + 4 * frame.poisson_error
        assert (k / frame.rho / most).max() > 1.05


@pytest.mark.parametrize("key", [0.0, 1.0])
def test_it_comes_from_the_keyframes_without_a_jump(key):
    first, second = grown()
    both = [HarmonicMap(cage=first.cage, phi=first.phi, psi=0.3 * first.phi**2 / 4), second]
    between = prepare_baseline("mesh-eta", both, MESH.vertices, MESH.triangles)
    assert between.frame(key).rho == 1.0
    beside = between.frame(abs(key - 1e-5))
    assert_allclose(beside.positions, between.frame(key).positions, rtol=0, atol=1e-3)


def test_affine_keyframes_have_affine_in_betweens_with_eta_linear():
    z = MESH.vertices
    keys = [1.2 * z + 0.1 * z.conj(), 1.1j * z + 0.3j * z.conj()]
    frame = prepare_baseline("mesh-eta", keys, z, MESH.triangles).frame(0.25)
    fz = 1.2**0.75 * 1.1**0.25 * np.exp(0.125j * np.pi)
    assert_allclose(frame.fz, fz, rtol=1e-10, atol=0)
    eta = 0.75 * 0.12 + 0.25 * 0.33
    assert_allclose(frame.fzbar, frame.rho * eta / np.conj(fz), rtol=1e-9, atol=0)
    assert frame.poisson_error < 1e-12
