"""Tables of what was measured on conveyors and belts: power, rolling resistance."""
