"""Keep bytes under the hash of their content: bytes go in, digests, streams and local files come out."""
