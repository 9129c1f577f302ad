"""Input files: bytes, YAML or JSON with positions, workbooks, compound folders, libraries; and safe writing."""
