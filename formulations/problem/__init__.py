"""The task: waypoints, limits and conditions, and the files that they are read from."""
