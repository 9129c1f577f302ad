"""Languages of reports: catalogues of their texts, and how a text of a report is translated by them."""
