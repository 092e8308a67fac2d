"""What every candidate cause promises: its sites, its admissible estimates, its statement."""
