"""Freeze what the product answers, so that a change of its code can be shown to change no answer."""
