"""Start and end processes: a function comes in, a forked process of it goes out."""
