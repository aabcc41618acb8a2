"""Serial chains of joints, whoever describes them, and how their tool moves.

link_chain      the chain: forward kinematics and Jacobian
plain_chain     the chain as plain data, and back
tool_point      the tool point on any kind of number: arrays, CasADi symbols, intervals, jets
jets            a function with its first two derivatives in time
reach_bounds    how far the tool can be from each joint, and how fast its derivatives can grow
"""
