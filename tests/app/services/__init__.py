"""Hold what several resources share to what it promises."""
