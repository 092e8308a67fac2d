"""Hold a diagnosis to naming what was hidden, and to silence where nothing was."""
