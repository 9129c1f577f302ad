"""Tables of reports, a file a part of the report: figures and columns, each declared once."""
