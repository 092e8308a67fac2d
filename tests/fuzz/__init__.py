"""Spoil sound files at random, by the million, and see that reading them never does worse than refuse."""
