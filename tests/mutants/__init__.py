"""Breaks of the product, one a patch, that the tests have to notice."""
