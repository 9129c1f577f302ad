"""Tables of measurements on conveyors and belts: power, rolling resistance."""
