"""Show the product at work: a log and a robot go in, the service's answer is printed beside the truth."""
