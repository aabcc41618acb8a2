"""Re-prove a certified bound, trusting nothing but this folder.

It shares no code with the prover. Every number is a ball of real numbers that contains the true one
(python-flint's arb, 128 bits), and a comparison is true only if it is true for all of them. Intervals
are pairs of such numbers. A proof about B-splines has a hundred thousand boxes: there the numbers are
arrays of floats, and each file states how their rounding is bounded.

The claim: no durations make a spline of the family through the waypoints that keeps the limits (positions to
within position_slack) and takes ``seconds`` or less. A stretch keeps the limits, so it is enough that no such
spline takes exactly L = seconds.

The checker derives the domain of the search from the problem and L. It replays the events in depth-first
order and verifies every discard: if multipliers >= 0 of necessary conditions g <= 0 make their weighted
sum positive on all of a box (or of a slab of it), no motion is there. Every box of the tree must end so.
A bound of every motion, whatever its family, is one such sum of inequalities.

claim, demands, reading the certificate read as exact numbers
tool                    limits on the tool, and the least times that follow from them
balls, answers          the arithmetic; the answers
families                one checker per family: its conditions, and what its events mean
verify, words           chooses the checker; writes its proof for people
"""
