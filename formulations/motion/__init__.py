"""A motion as exact piecewise polynomials, the check that judges it, and files of motions."""
