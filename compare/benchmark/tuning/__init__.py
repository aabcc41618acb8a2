"""Constants of swarms, tuned on the open instances with the same effort for each swarm."""
