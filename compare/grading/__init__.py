"""What ``timebound grade`` and ``timebound versus`` say: runs, statistics, one verdict, one page.

names         ``mine.py:swarm``, ``module:function``, ``library:Name``: what is graded
protocol      which runs a grading consists of
cells         the runs of one swarm on one instance: losses, gaps, hitting times
contest       two swarms over all instances: the effect, and the rule that makes a verdict of it
standing      every swarm of a grading, from CMA-ES to random search
reasons       which features of the instances go with the advantage
zero          whether the swarm is drawn to zero
failures      runs that failed, said as they happen
grading       all of it for one swarm; page and figures show it
"""
