"""What can be hidden in the plant: a joint and an arm's scales come in, an effect that acts on the plant goes out."""
