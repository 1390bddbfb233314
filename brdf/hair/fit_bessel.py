#!/usr/bin/python3
"""Print the coefficients of brdf/hair/bessel.h: rational fits of exp(-x) I0(x) for x <= 8 (in x / 8) and of
sqrt(x) exp(-x) I0(x) for x >= 8 (in 16 / x - 1), with the relative error of each. Needs mpmath; takes a minute."""
import mpmath as mp

mp.mp.dps = 45
JOIN = mp.mpf(8)


def near(t):  # t = 2 x / 8 - 1
    x = (t + 1) / 2 * JOIN
    return mp.besseli(0, x) * mp.exp(-x)


def far(t):  # t = 16 / x - 1
    x = 2 * JOIN / (1 + t)
    if x < 300:
        return mp.besseli(0, x) * mp.exp(-x) * mp.sqrt(x)
    total, term, k = mp.mpf(0), mp.mpf(1), 0  # asymptotic series: term k is ((2k-1)!!)^2 / (k! (8x)^k)
    while term > mp.mpf(10) ** -45:
        total += term
        k += 1
        term *= (2 * k - 1) ** 2 / (8 * k * x)
    return total / mp.sqrt(2 * mp.pi)


def fit(f, n, m, rounds=12):
    """p of degree n and q of degree m (q0 = 1), in Chebyshev polynomials: least squares of (p - f q) / (f q), weighted
    towards its largest errors (Sanathanan-Koerner and Lawson)."""
    count = 6 * (n + m)
    nodes = [mp.cos(mp.pi * (k + mp.mpf(1) / 2) / count) for k in range(count)]
    values = [f(t) for t in nodes]
    basis = [[mp.cos(j * mp.acos(t)) for j in range(max(n, m) + 1)] for t in nodes]
    weight, bottom, best = [mp.mpf(1)] * count, [mp.mpf(1)] * count, None
    for _ in range(rounds):
        a, b = mp.matrix(count, n + 1 + m), mp.matrix(count, 1)
        for i in range(count):
            s = weight[i] / (values[i] * abs(bottom[i]))
            for j in range(n + 1):
                a[i, j] = s * basis[i][j]
            for j in range(1, m + 1):
                a[i, n + j] = -s * values[i] * basis[i][j]
            b[i] = s * values[i]
        x = mp.lu_solve(a, b)
        p = [x[j] for j in range(n + 1)]
        q = [mp.mpf(1)] + [x[n + j] for j in range(1, m + 1)]
        bottom = [sum(c * basis[i][j] for j, c in enumerate(q)) for i in range(count)]
        error = [abs(sum(c * basis[i][j] for j, c in enumerate(p)) / bottom[i] / values[i] - 1) for i in range(count)]
        if best is None or max(error) < best[0]:
            best = (max(error), p, q)
        weight = [w * mp.sqrt(e / max(error) + mp.mpf(1) / 50) for w, e in zip(weight, error)]
    return best


def monomials(c):
    """Of a sum of Chebyshev polynomials."""
    series = [[mp.mpf(1)], [mp.mpf(0), mp.mpf(1)]]
    while len(series) < len(c):
        following = [mp.mpf(0)] + [2 * x for x in series[-1]]
        for i, x in enumerate(series[-2]):
            following[i] -= x
        series.append(following)
    return [sum(c[k] * series[k][i] for k in range(i, len(c)) if i < len(series[k])) for i in range(len(c))]


def in_halves(c):
    """Of a polynomial in t = 2 w - 1, the coefficients in w."""
    return [sum(c[k] * mp.binomial(k, i) * mp.mpf(2) ** i * (-1) ** (k - i) for k in range(i, len(c)))
            for i in range(len(c))]


for name, digits, near_degrees, far_degrees in (("double", 18, (11, 9), (9, 8)), ("float", 9, (8, 4), (5, 0))):
    for end, f, degrees in (("Near", near, near_degrees), ("Far", far, far_degrees)):
        error, p, q = fit(f, *degrees)
        p, q = monomials(p), monomials(q)
        if end == "Near":
            p, q = in_halves(p), in_halves(q)
        print(f"{name}: relative error {mp.nstr(error, 3)}")
        for part, c in (("Top", p), ("Bottom", q)):
            print(f"  k{end}{part}{{" + ", ".join(mp.nstr(x / q[0], digits) for x in c) + "}")
