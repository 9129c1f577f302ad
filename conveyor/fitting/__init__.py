"""Fit laboratory files to a compound; write its page to sign and the input of other programs."""
