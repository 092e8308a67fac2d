"""Find out what is in an uploaded file: bytes go in, a summary or a problem comes out."""
