"""Recognise controllers in logs of machines whose controllers are known."""
