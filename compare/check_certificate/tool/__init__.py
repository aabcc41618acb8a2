"""Limits on the tool that a certificate states, and the least times of the segments that follow.

link         one joint between fixed poses
chain        the chain of links from base to tool: its point, slopes and curvature, and all that it can reach
least_times  the way between the tool points of two waypoints, over the tool's speed
words        both for people
"""
