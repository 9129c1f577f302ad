"""Reference cases: converged contacts, published figures, conveyors with printed or measured results."""
