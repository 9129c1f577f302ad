"""Files from outside: their bytes, their YAML or JSON with positions, the folders of compounds, the libraries."""
