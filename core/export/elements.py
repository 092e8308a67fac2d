"""Write elements as XML: numbers with all their digits, comments that XML allows, one element a line."""

import textwrap
from collections.abc import Iterable
from xml.etree import ElementTree as ET

import numpy as np

WIDTH = 110


def child(parent: ET.Element, tag: str, /, **attributes: object) -> ET.Element:
    """Add an element; attributes that are None are left out, numbers keep all their digits."""
    return ET.SubElement(
        parent, tag, {name: text_of(value) for name, value in attributes.items() if value is not None}
    )


def text_of(value: object) -> str:
    """Write a text, a number or an array of numbers.

    Examples
    --------
    >>> text_of(np.array([0.1, -0.0, 1e-5]))
    '0.1 0.0 1e-05'
    """
    if isinstance(value, np.ndarray):
        return " ".join(text_of(entry) for entry in value.ravel())
    if isinstance(value, float | np.floating):
        return repr(float(value) + 0.0)  # a zero without a sign
    return str(value)


def comment(parent: ET.Element, sentences: Iterable[str]) -> None:
    """Add a comment of wrapped sentences, one paragraph each; two hyphens, which XML forbids, are parted."""
    paragraphs = (
        textwrap.fill(sentence, WIDTH, initial_indent="  ", subsequent_indent="    ", break_long_words=False)
        for sentence in sentences
    )
    text = "\n".join(paragraphs).replace("--", "- -").replace("--", "- -")
    parent.append(ET.Comment(f"\n{text}\n"))


def document(root: ET.Element) -> str:
    """Write a document, indented."""
    ET.indent(root)
    return '<?xml version="1.0"?>\n' + ET.tostring(root, encoding="unicode") + "\n"
