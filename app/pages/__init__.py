"""Hold the pages that people read, plain HTML, styles and scripts that work offline; write their tables."""
