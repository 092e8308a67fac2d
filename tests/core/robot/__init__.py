"""Robot descriptions and the bodies in them, held against textbooks and other readers of the same files."""
