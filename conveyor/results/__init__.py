"""Results as people use them: tables, workbooks, pages and figures of what is calculated."""
