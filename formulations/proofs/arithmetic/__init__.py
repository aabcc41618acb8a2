"""Arithmetic rounded outward: scalars in compiled code, and intervals on whole arrays."""
