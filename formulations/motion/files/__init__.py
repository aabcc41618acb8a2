"""Motions as files: points at times, or exact polynomial pieces; readers and writers of each format."""
