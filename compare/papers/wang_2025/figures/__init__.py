"""Figures of Wang 2025; Figs 12 to 14 are made with Table 10."""
