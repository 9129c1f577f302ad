"""What lies under the roll: creep spectra, elastic and viscoelastic layers, the belt as a layer."""
