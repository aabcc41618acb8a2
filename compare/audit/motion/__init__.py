"""A printed time vector as a motion: its peaks for every reading of the digits, and proved least times."""
