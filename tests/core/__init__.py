"""Mirror core: what each chapter claims, held against laws, other engines and published numbers."""
