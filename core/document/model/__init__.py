"""Write and read the model of a result: in comes a document, out goes the identified robot; and back."""
