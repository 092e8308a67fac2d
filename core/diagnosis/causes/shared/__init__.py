"""Parts that several causes share: joints and links, harmonics, events, bodies, text."""
