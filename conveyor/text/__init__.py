"""Text for people and terminals: HTML of values, control characters escaped, ranges read."""
