"""Kill and freeze the parts of a running service at random moments, and count what that did to its jobs."""
