"""Say in a word how well a joint is predicted, without a module that computes anything."""

QUALITIES = (("good", 10.0), ("fair", 25.0), ("poor", 50.0), ("failed", float("inf")))
"""Words for an error in per cent of the RMS torque, with the largest that each is said of. Set by hand:
drives of measured arms leave 1 to 10 %, and a model that leaves more than half describes no joint."""


def quality(error_percent: float) -> str:
    """Say in a word how well a joint is predicted.

    Examples
    --------
    >>> quality(3.0), quality(106.0)
    ('good', 'failed')
    """
    return next(word for word, largest in QUALITIES if error_percent <= largest)
