"""The pages in a real browser: what people click, type, see and hear, and what the pages ask of whom."""
