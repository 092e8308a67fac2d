"""What can be hidden: an arm and its motion come in, an effect that acts on the plant goes out."""
