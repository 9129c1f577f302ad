"""What a reader must know beside the results: assumptions and warnings."""
