"""Keep one file per cause: what it expects, where it can act, what it adds, and what it is confused with."""
