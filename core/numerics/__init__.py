"""Hold numerical methods that several chapters share: series and probabilities come in, the same go out."""
