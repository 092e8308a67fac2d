"""Store and read the signals of a study at every sample."""
