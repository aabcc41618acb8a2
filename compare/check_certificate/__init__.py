"""Re-prove a certified bound, trusting nothing but this folder.

It shares no code with the prover. Every number is a ball of real numbers that contains the true one
(python-flint's arb, 128 bits); a comparison holds only if it holds for all of them. Intervals are pairs
of such numbers. The claim: no durations make a spline of the family through the waypoints that keeps
the limits (positions to within position_slack) and takes ``seconds`` or less. As stretching keeps
limits, it is enough that none takes exactly L = seconds.

The domain of a search is derived here from problem and L. Its events are replayed in depth-first
order, every discard is verified: multipliers >= 0 of necessary conditions g <= 0 whose weighted sum is
positive on all of a box (or of a slab of it) leave no motion there. Every box of the tree must end so.

A bound of every motion, whatever its family, is one such sum, of rows that ``relaxation`` builds anew.
"""
