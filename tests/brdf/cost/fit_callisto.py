#!/usr/bin/env python3
"""The diffuse part of Callisto as near to `microfacet_diffuse` as it comes: numbers of brdf/cost/surface_ladders.cc.

    python3 tests/brdf/cost/fit_callisto.py build/release/likeness

Least squares of f cos_i cos_o over draws as those of `likeness cost evaluators --family diffuse`, and the error over
draws that it has not seen. The two intensities are linear in alpha and 1 at alpha 0, the falloffs constant. Needs
numpy and scipy.
"""
import os
import subprocess
import sys
import tempfile

import numpy as np
from scipy.optimize import least_squares

random = np.random.default_rng(3)
COLUMNS = "alpha,light_x,light_y,light_z,view_x,view_y,view_z"


def draws(count):
    def directions():
        r, phi = np.sqrt(random.random(count)), 2 * np.pi * random.random(count)
        return np.stack([r * np.cos(phi), r * np.sin(phi), np.sqrt(1 - r * r)], 1)
    return random.random(count), directions(), directions()


def integral(alpha, light, view):
    with tempfile.TemporaryDirectory() as folder:
        table, out = os.path.join(folder, "in.csv"), os.path.join(folder, "out.csv")
        np.savetxt(table, np.column_stack([alpha, light, view]), "%.17g", ",", header=COLUMNS, comments="")
        subprocess.run([sys.argv[1], "eval", "microfacet_diffuse", "--in", table, "--out", out], check=True)
        return np.genfromtxt(out, delimiter=",", names=True)["f_over_base"]


def callisto(x, alpha, light, view):
    rise_slope, n_f, m_f, retro_slope, n_r, m_r = x
    half = light + view
    length = np.linalg.norm(half, axis=1)
    cos_h, cos_d = np.clip(half[:, 2] / length, 0, 1), np.minimum(length / 2, 1)
    rise = (1 - cos_d) ** (10 * (1 - n_f)) * cos_h ** (10 * (1 - m_f))
    retro = (1 - cos_h) ** (10 * (1 - n_r)) * cos_d ** (10 * (1 - m_r))
    return (1 + rise_slope * alpha * rise) * (1 + retro_slope * alpha * retro) / np.pi


fitted, unseen = [(*d, integral(*d)) for d in (draws(20000), draws(20000))]


def difference(x, data):
    *d, f = data
    weight = d[1][:, 2] * d[2][:, 2]
    return weight * (callisto(x, *d) - f) / np.sqrt(np.sum((weight * f) ** 2))


best = None
for start in range(8):
    x0 = np.array([0, 0.75, 0.75, 4, 0.75, 0.75]) + random.normal(size=6) * [0.3, 0.1, 0.1, 2, 0.1, 0.1]
    # -1: no intensity below 0 at alpha 1.
    bounds = ([-1, 0, 0, -1, 0, 0], [255, 1, 1, 255, 1, 1])
    found = least_squares(difference, np.clip(x0, *bounds), bounds=bounds, args=(fitted,))
    best = found if best is None or found.cost < best.cost else best
print("diffuse_fresnel = 1 + %.3f alpha, falloff %.3f, tangent falloff %.3f" % tuple(best.x[:3]))
print("retroreflection = 1 + %.3f alpha, falloff %.3f, tangent falloff %.3f" % tuple(best.x[3:]))
print("relative RMS of f cos_i cos_o: %.4f, of unseen draws %.4f" % tuple(
    np.linalg.norm(difference(best.x, data)) for data in (fitted, unseen)))
