"""Hold the documents to their word: what they tell a reader to type runs, what they link to is there."""
