"""Fields and energies of a solved contact: surface, interior, working strain, first law."""
