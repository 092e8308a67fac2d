"""Spoil one thing in robots and logs that agree, and ask whether it is named."""
