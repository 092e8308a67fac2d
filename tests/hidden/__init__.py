"""The scored diagnosis: cases of the plant come in, a confusion table with intervals goes out."""
