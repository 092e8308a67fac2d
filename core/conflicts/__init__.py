"""Ask whether a robot's description and its logs belong together, before anything is concluded from them."""
