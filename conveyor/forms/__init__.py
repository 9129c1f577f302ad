"""What people fill in: the fields of the models, the sheets they stand on, and a filled-in workbook as plain data.

Nothing here lists the fields of a conveyor; `conveyor.template` draws the same sheets.
"""
