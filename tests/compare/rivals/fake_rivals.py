"""Rivals that crash, hang, lie or break limits."""

import os
import time

from compare.rivals.rival import RivalAnswer
from formulations import free_form


def crash(problem, seconds):
    os.abort()


def fail(problem, seconds):
    raise ValueError("no such thing")


def hang(problem, seconds):
    time.sleep(600)


def lie(problem, seconds):
    return RivalAnswer(free_form(problem).trajectory, 0.5)


def hasten(problem, seconds):
    motion = free_form(problem).trajectory.stretched(0.9)
    return RivalAnswer(motion, motion.seconds)


def honest(problem, seconds):
    motion = free_form(problem).trajectory.stretched(1.5)
    return RivalAnswer(motion, motion.seconds)
