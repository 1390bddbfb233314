#!/usr/bin/env python3
"""Fits the closed forms of brdf/hair/closed.h to the far field of a fibre and prints brdf/hair/closed_fit.h:

    python3 brdf/hair/fit_closed.py > brdf/hair/closed_fit.h

Needs numpy and scipy; takes about a minute. The far field is summed here from its definition, apart from the C++ code.
Fitted at eta = 1.55 over azimuth, inclination 0 to 87 degrees, azimuthal roughness 0.1 to 1, absorption 0 to 3.
"""
import sys

import numpy as np
from numpy.polynomial import chebyshev
from scipy.optimize import least_squares

ETA = 1.55
PHI = np.linspace(0, np.pi, 41)
PHI_WEIGHT = np.where((PHI == 0) | (PHI == np.pi), 0.5, 1) / 40
BETA = np.array([.1, .13, .17, .22, .28, .35, .43, .52, .62, .72, .82, .9, .96, 1])
COS = np.cos(np.radians([0, 12, 24, 33, 40, 46, 52, 58, 64, 70, 76, 82, 87]))
SIGMA = np.array([.1, .5, 1, 2, 3])
WIDTH = np.sqrt(np.pi / 8) * (.265 * BETA + 1.194 * BETA**2 + 5.372 * BETA**22)
Q = WIDTH / (WIDTH + .3)  # what stands for the width in the fits
X, G = np.cos(PHI), 4 * np.sin(PHI / 2)**2
ENERGY_WEIGHT = 2.0  # of the error of a lobe's energy, beside the rms error of its value


# ---- the far field

nodes, node_weights = np.polynomial.legendre.leggauss(240)
GAMMA = (nodes + 1) * np.pi / 4
H = np.sin(GAMMA)
H_WEIGHT = node_weights * np.pi / 4 * np.cos(GAMMA)


def fresnel(cosine):
    inner = np.sqrt(ETA**2 - 1 + cosine**2)
    across, along = (cosine - inner) / (cosine + inner), (ETA**2 * cosine - inner) / (ETA**2 * cosine + inner)
    return 0.5 * (across**2 + along**2)


def paths(c):
    """Fresnel, length of one pass and gamma_t, for every offset."""
    outer = np.sqrt(ETA**2 - 1 + c * c)
    sine = H * c / outer
    return fresnel(c * np.sqrt(1 - H * H)), 2 * np.sqrt(1 - sine**2) * ETA / outer, np.arcsin(sine)


def attenuation(p, c, sigma):
    f, way, _ = paths(c)
    t = np.exp(-sigma * way)
    return [f, (1 - f)**2 * t, (1 - f)**2 * f * t**2, (1 - f)**2 * f**2 * t**3 / (1 - f * t)][p]


def logistic(x, s):
    e = np.exp(-np.abs((x + np.pi) % (2 * np.pi) - np.pi) / s)
    return e / (s * (1 + e)**2 * np.tanh(np.pi / 2 / s))


def far(p, c, s, sigma=0.0):
    """N_p over PHI."""
    a = attenuation(p, c, sigma) * H_WEIGHT
    centre = 2 * (p * paths(c)[2] - GAMMA) + p * np.pi
    return 0.5 * (logistic(PHI[:, None] - centre, s) + logistic(PHI[:, None] + centre, s)) @ a


def least_way(c):
    return 2 * ETA * np.sqrt(ETA**2 - 1) / (ETA**2 - 1 + c * c)


# ---- the fits. Coefficients are of Chebyshev polynomials in 2 q - 1 and 2 cos - 1, printed as powers.

def basis_s(degree):
    return chebyshev.chebvander(2 * Q - 1, degree)


def basis_c(degree):
    return chebyshev.chebvander(2 * COS - 1, degree)


def powers(a):
    """Chebyshev coefficients along both last axes, as coefficients of powers."""
    a = np.apply_along_axis(chebyshev.cheb2poly, -1, a)
    return np.apply_along_axis(chebyshev.cheb2poly, -2, a)


def quality(name, n, reference):
    e = n - reference
    rms = np.sqrt((PHI_WEIGHT * e * e).sum(-1) / (PHI_WEIGHT * reference**2).sum(-1))
    energy = (PHI_WEIGHT * n).sum(-1) / (PHI_WEIGHT * reference).sum(-1) - 1
    print(f"{name}: rms {rms.mean():.4f} mean, {rms.max():.4f} worst; energy {np.sqrt((energy**2).mean()):.4f} rms, "
          f"{np.abs(energy).max():.4f} worst; beta_n >= 0.2: rms {rms[3:].max():.4f}, "
          f"energy {np.abs(energy[3:]).max():.4f}", file=sys.stderr)


def solve(model, start, reference):
    scale = np.sqrt((PHI_WEIGHT * reference**2).sum(-1, keepdims=True))
    energy = (PHI_WEIGHT * reference).sum(-1)

    def residuals(a):
        n = model(a)
        value = (n - reference) / scale * np.sqrt(PHI_WEIGHT)
        whole = ENERGY_WEIGHT * ((PHI_WEIGHT * n).sum(-1) / energy - 1)
        return np.clip(np.concatenate([value.ravel(), whole.ravel()]), -50, 50)

    return least_squares(residuals, start, max_nfev=150, x_scale='jac').x


def surfaces(a, count, s, c):
    """`count` polynomials over width and cosine, [width, cosine, count]."""
    a = a.reshape(count, s.shape[1], c.shape[1])
    return np.einsum('kij,si,cj->sck', a, s, c)


def fit_r(reference):
    """N_R = y exp(a + b y + c y^2), y = sqrt(cos^2(phi / 2) + w^2), w = q (w0 + w1 q)."""
    s, c = basis_s(2), basis_c(3)

    def model(a):
        w = Q * (a[0] + a[1] * Q)
        y = np.sqrt(np.cos(PHI / 2)**2 + (w * w)[:, None, None])
        k = surfaces(a[2:], 3, s, c)
        return y * np.exp(np.clip(k[..., 0:1] + k[..., 1:2] * y + k[..., 2:3] * y * y, -60, 6))

    start = np.zeros((3, 3, 4))
    start[0, 0, 0], start[1, 0, 0] = 1, -2
    a = solve(model, np.concatenate([[.13, .45], start.ravel()]), reference)
    quality("R", model(a), reference)
    return a[:2], powers(a[2:].reshape(3, 3, 4))


def fit_tt(reference):
    """N_TT = cos^2 exp(polynomial of degree 3 in cos(phi))."""
    s, c, x = basis_s(4), basis_c(3), np.vander(X, 4, increasing=True)

    def model(a):
        return np.exp(np.clip(surfaces(a, 4, s, c) @ x.T, -60, 6))

    weight = reference / reference.max(-1, keepdims=True)
    linear = np.einsum('si,cj,pk->scpkij', s, c, x).reshape(-1, 80)
    start = np.linalg.lstsq(linear * weight.reshape(-1, 1), (np.log(np.maximum(reference, 1e-12)) * weight).ravel(),
                            rcond=None)[0]
    a = solve(model, start, reference)
    quality("TT", model(a), reference)
    return powers(a.reshape(4, 5, 4)), model(a)


def fit_trt(reference):
    """N_TRT = cos^2 exp(a - b g / (sqrt(r^2 + g) + r) + c g), g = 4 sin^2(phi / 2)."""
    s, c, s_r, c_r = basis_s(3), basis_c(4), basis_s(2), basis_c(2)

    def model(a):
        r2 = surfaces(a[:9], 1, s_r, c_r)**2 + 1e-6
        k = surfaces(a[9:], 3, s, c)
        root = G / (np.sqrt(r2 + G) + np.sqrt(r2))
        return np.exp(np.clip(k[..., 0:1] - k[..., 1:2] * root + k[..., 2:3] * G, -60, 6))

    start = np.zeros((3, 4, 5))
    start[0, 0, 0], start[1, 0, 0], start[1, 1, 0] = -2, 6, -5
    start_r = np.zeros((3, 3))
    start_r[0, 0], start_r[1, 0] = .7, .3
    a = solve(model, np.concatenate([start_r.ravel(), start.ravel()]), reference)
    quality("TRT", model(a), reference)
    return powers(a[:9].reshape(1, 3, 3))[0], powers(a[9:].reshape(3, 4, 5)), model(a)


def fit_way(name, p, bare, fitted, degrees, curves):
    """ln N falls by sigma (p least + more / (1 + curve sigma)), more a polynomial in cos(phi), width and cosine."""
    kx, ks, kc = degrees
    reference = np.array([[[far(p, c, s, sigma) for sigma in SIGMA] for c in COS] for s in WIDTH])
    reference /= (COS**2)[None, :, None, None]
    sigma = np.broadcast_to(SIGMA[None, None, :, None], reference.shape)
    seen = np.log(bare[:, :, None, :] / reference) / sigma - p * least_way(COS)[None, :, None, None]
    weight = np.sqrt(reference / reference.max(-1, keepdims=True) * PHI_WEIGHT) * sigma
    x = np.vander(X, kx + 1, increasing=True)
    linear = np.einsum('si,cj,pk->scpkij', basis_s(ks), basis_c(kc), x).reshape(len(BETA), len(COS), 1, len(PHI), -1)
    linear = np.broadcast_to(linear, reference.shape + linear.shape[-1:]).reshape(sigma.size, -1)
    best = None
    for curve in curves:
        w = (weight / (1 + curve * sigma)).ravel()
        goal = (seen * (1 + curve * sigma)).ravel()
        a = np.linalg.lstsq(linear * w[:, None], goal * w, rcond=None)[0]
        left = (((linear @ a - goal) * w)**2).sum()
        if best is None or left < best[0]:
            best = left, curve, a
    _, curve, a = best
    n = fitted[:, :, None, :] * np.exp(-sigma * (p * least_way(COS)[None, :, None, None] +
                                                 (linear @ a).reshape(reference.shape) / (1 + curve * sigma)))
    for i, value in enumerate(SIGMA):
        quality(f"{name} at sigma_a {value}", n[:, :, i], reference[:, :, i])
    return curve, powers(a.reshape(kx + 1, ks + 1, kc + 1))


def fit_longer():
    """N of all longer paths = cos / (2 pi) exp(polynomial in cos) t^3 u / (u + (1 - u) (1 - t)), t = exp(-sigma way):
    as if the Fresnel term, 1 - u, and the way of a pass were the same for every offset."""
    sigmas = np.array([0, .05, .1, .3, .5, 1, 1.5, 2, 3, 4])
    cos = np.linspace(.02, 1, 40)
    energy = np.array([[(attenuation(3, c, sigma) * H_WEIGHT).sum() for sigma in sigmas] for c in cos])
    bare = np.linalg.lstsq(np.vander(cos, 5, increasing=True), np.log(energy[:, 0] / cos), rcond=None)[0]

    def model(a):
        u = cos / np.polyval(a[3::-1], cos)  # cos / u is the polynomial
        way = least_way(cos) * np.polyval(a[:3:-1], cos)
        t = np.exp(-sigmas * way[:, None])
        return t**3 * u[:, None] / (u[:, None] + (1 - u[:, None]) * (1 - t))

    share = energy / energy[:, :1]
    a = least_squares(lambda a: (np.log(model(a) / share)).ravel(), [.2, 1, .5, 0, 1, 0, 0]).x
    n = np.exp(np.vander(cos, 5, increasing=True) @ bare) * cos
    print("longer: without absorption", np.abs(n / energy[:, 0] - 1).max(), "with",
          np.abs(model(a) / share - 1).max(0), file=sys.stderr)
    return bare, a[:4], a[4:]


# ---- the header

def number(x):
    return f"{x:.8g}"


def array(values):
    return "{" + ", ".join(number(v) for v in values) + "}"


def table(name, a):
    """[term][power of the width][power of the cosine]."""
    a = np.asarray(a)
    if a.ndim == 2:
        a = a[None]
    print(f"inline constexpr double {name}[{a.shape[0]}][{a.shape[1]}][{a.shape[2]}]{{")
    for term in a:
        print("    {" + ",\n     ".join(array(row) for row in term) + "},")
    print("};")


def main():
    bare = {p: np.array([[far(p, c, s) / (c * c if p else 1) for c in COS] for s in WIDTH]) for p in range(3)}
    r_width, r = fit_r(bare[0])
    tt, tt_fitted = fit_tt(bare[1])
    trt_root, trt, trt_fitted = fit_trt(bare[2])
    tt_curve, tt_way = fit_way("TT", 1, bare[1], tt_fitted, (1, 2, 2), np.linspace(0, .2, 41))
    trt_curve, trt_way = fit_way("TRT", 2, bare[2], trt_fitted, (1, 1, 2), np.linspace(0, .4, 41))
    longer, longer_u, longer_way = fit_longer()

    print("""#pragma once

// Printed by brdf/hair/fit_closed.py: the coefficients of brdf/hair/closed.h. Tables are [term][power of 2 q - 1][power of
// 2 cos(theta) - 1]; the last three are in powers of cos(theta).
namespace likeness::brdf::closed_fit {

// clang-format off""")
    print(f"inline constexpr double kRWidth[]{array(r_width)};")
    table("kR", r)
    table("kTt", tt)
    table("kTtWay", tt_way)
    print(f"inline constexpr double kTtCurve = {number(tt_curve)};")
    table("kTrtRoot", trt_root)
    table("kTrt", trt)
    table("kTrtWay", trt_way)
    print(f"inline constexpr double kTrtCurve = {number(trt_curve)};")
    print(f"inline constexpr double kLonger[]{array(longer)};")
    print(f"inline constexpr double kLongerLoss[]{array(longer_u)};")
    print(f"inline constexpr double kLongerWay[]{array(longer_way)};")
    print("""// clang-format on

}  // namespace likeness::brdf::closed_fit""")


main()
