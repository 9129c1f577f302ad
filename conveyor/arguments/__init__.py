"""Arguments of public functions: their types, their limits, arrays of numbers; refused in the words of specs."""
