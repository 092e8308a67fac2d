"""Share what several causes need: joints and links, waves, events, bodies."""
