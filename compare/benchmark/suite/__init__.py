"""The instances of the benchmark: plain data with digests, proofs and features."""

from compare.benchmark.suite.catalogue import SIZE, suite
from compare.benchmark.suite.chosen import chosen
from compare.benchmark.suite.instance import Instance, Split

__all__ = ["SIZE", "Instance", "Split", "chosen", "suite"]
