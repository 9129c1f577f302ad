"""Contacts of a given load: one strip, many at once, several strips on a grid."""
