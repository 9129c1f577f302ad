"""Friction of one contact over its load."""
