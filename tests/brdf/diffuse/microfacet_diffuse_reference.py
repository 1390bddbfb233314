#!/usr/bin/python3
"""Print tests/brdf/diffuse/microfacet_diffuse.csv: f / rho of Lambertian microfacets with GGX normals, unshadowed, to 17
digits, at 160 points of which many are at the ends of their ranges. Needs mpmath; takes ten minutes.

Written apart from brdf/diffuse/microfacet_diffuse.h: in polar coordinates of the slope, the azimuth in closed form
between the angles where a facet turns from the light or the viewer, the radius by tanh-sinh quadrature of its logarithm,
split where an azimuth interval opens or two of them meet."""
import random

from mpmath import acos, ceil, cos, exp, floor, log, mp, mpf, nstr, pi, quad, sin, sqrt

mp.dps = 25


def f_over_base(alpha, theta_o, theta_i, phi):
    a, theta_o, theta_i, phi = (mpf(x) for x in (alpha, theta_o, theta_i, phi))
    oz, ox = cos(theta_o), sin(theta_o)
    iz, ix = cos(theta_i), sin(theta_i)

    def around(r):  # the integral over the azimuth t of max(0, oz - ox r cos t) max(0, iz - ix r cos(t - phi))
        ends = {mpf(0), 2 * pi}
        for z, x, center in ((oz, ox, mpf(0)), (iz, ix, phi)):
            if x * r > z:
                half = acos(z / (x * r))
                for t in (center - half, center + half):
                    ends.add(t - 2 * pi * floor(t / (2 * pi)))
        ends = sorted(ends)

        def primitive(t):
            return (oz * iz * t - oz * ix * r * sin(t - phi) - iz * ox * r * sin(t)
                    + ox * ix * r * r * (t * cos(phi) / 2 + sin(2 * t - phi) / 4))

        total = mpf(0)
        for low, high in zip(ends, ends[1:]):
            if high - low <= mpf(10) ** -22:
                continue
            t = (low + high) / 2
            if oz - ox * r * cos(t) > 0 and iz - ix * r * cos(t - phi) > 0:
                total += primitive(high) - primitive(low)
        return total

    breaks = [a]
    for z, x in ((oz, ox), (iz, ix)):
        if x > 0:
            breaks.append(z / x)
    if abs(ox * ix * sin(phi)) > mpf(10) ** -20:  # where both are grazed at once
        p = oz / ox
        q = (iz / ix - p * cos(phi)) / sin(phi)
        breaks.append(sqrt(p * p + q * q))
    breaks = sorted(b for b in breaks if b < mpf(10) ** 12)
    top = max(breaks + [mpf(1)])
    panels = [log(min(breaks)) - 35]
    for end in [log(b) for b in breaks] + [log(top) + 3, log(top) + 40]:
        start = panels[-1]
        count = int(ceil((end - start) / 4)) or 1
        panels += [start + (end - start) * k / count for k in range(1, count + 1)]

    def weighted(x):
        r = exp(x)
        return around(r) * a * a / (pi * (a * a + r * r) ** 2 * sqrt(1 + r * r)) * r * r

    return quad(weighted, panels) / (pi * oz * iz)


random.seed(20240611)
DEGREE = 3.14159265358979323846 / 180
print("alpha,theta_o,theta_i,phi,ref_f_over_base")
for _ in range(160):
    alpha = random.choice([1e-4, 1e-3, 1e-2, .1, .5, 1.0, random.random(), random.random(), 10 ** random.uniform(-4, 0)])

    def angle():
        return random.choice([0.0, 89.9 * DEGREE, 89.9 * DEGREE, 80 * DEGREE, random.uniform(0, 1.55),
                              random.uniform(0, 1.55), random.uniform(1.4, 89.9 * DEGREE)])

    theta_o = angle()
    theta_i = random.choice([angle(), angle(), angle(), theta_o])
    phi = random.choice([0.0, 3.141592653589793, random.uniform(0, 3.1415926), random.uniform(0, 3.1415926),
                         random.uniform(0, 3.1415926), 1e-3, 3.141592653589793 - 1e-3, 1.5707963267948966])
    print("%r,%r,%r,%r,%s" % (alpha, theta_o, theta_i, phi, nstr(f_over_base(alpha, theta_o, theta_i, phi), 17)))
