"""Write the identified robot for others: in comes a result document, out go files that other tools read."""
