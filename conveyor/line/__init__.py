"""The strands of a conveyor: loads, drags, flexure and indentation of the rolls of every section."""
