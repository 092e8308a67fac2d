"""Write the generated pages of the documentation: the contract comes in, Markdown goes out."""
