"""The Galerkin matrix of one strip: Bessel products, quadrature, spectral sums, orders beyond the core, pressures."""
