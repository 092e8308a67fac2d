"""Play controlled robots along logs, and hold them to mechanics and to each other."""
