"""Hold the pages that people read: in comes nothing from elsewhere, out go plain HTML, styles and scripts that work offline."""
