"""A package of somebody else, typed throughout, that needs nothing but the face of the project."""
