"""Limits on the tool that a certificate states, and the least times of the segments that follow.

chain        the chain of fixed poses and joints from base to tool: its point, slopes and curvature
least_times  the distance between the tool points of two waypoints, over the tool's speed
words        both for people
"""
