"""Statistics of runs: arrays in, typed results out. Nothing here knows a benchmark.

All of it is computed by SciPy, statsmodels (Holm), scikit-posthocs (critical difference) and baycomp
(practical equivalence); what is random takes a seed.

runtimes      hitting times, fixed-target ECDF, expected running time, success rate, area over the curve
medians       the median of some runs, and the gain of one over another, with intervals
pairs         two sets of runs on one instance: Mann-Whitney, Holm, Vargha-Delaney A12
seeds         how many seeds it would take
instances     several algorithms over all instances: Friedman, Wilcoxon, critical difference, profiles
equivalence   better, worse or alike over all instances; practical equivalence
cells         a table with a hole is refused
"""
