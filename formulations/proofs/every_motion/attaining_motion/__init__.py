"""A motion whose duration meets the lower bound: its segment durations, its waypoint states, itself.

durations   segment durations near those of the relaxation that a motion can have
states      velocities and accelerations at the waypoints for given durations
state_descent   durations and states at once, for many waypoints: sequential quadratic programs
chain_task      what it has to keep
chain_columns   where its variables stand
trust_region    how far a step goes
cruising_start  a guess for dense paths, without stops
smooth_timing   where dense paths begin
peaks           top speed while an acceleration at a waypoint fades
reach_rows      what such a point violates, to first and second order
motion      the motion between these states
relaxed_motion  the relaxation's waypoint states, where searches from elsewhere begin
hunt        what of it is tried while the bound is proved

The bound does not depend on any of this: the motion is judged by the independent check.
"""
