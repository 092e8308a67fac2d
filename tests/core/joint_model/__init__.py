"""Test the identification of single joints on exact simulations and on a measured slide."""
