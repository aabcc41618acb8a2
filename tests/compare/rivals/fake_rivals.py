"""Rivals that crash, hang, lie or break limits."""

import os
import time
from dataclasses import replace

import numpy as np

from compare.rivals.rival import RivalAnswer
from formulations import Conditions, free_form


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


def plain(problem, seconds):
    assert problem.conditions.none, problem.conditions.asked
    return honest(problem, seconds)


def cut(problem, seconds):
    inside = free_form(replace(problem, conditions=Conditions(tolerance={1: np.array([0.05, 0.05])})))
    return RivalAnswer(inside.trajectory, inside.seconds)
