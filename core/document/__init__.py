"""Write and read the result document: in come the results of all chapters, out goes plain JSON; and back."""
