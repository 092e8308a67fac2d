"""Hold the pages to what they promise a browser."""
