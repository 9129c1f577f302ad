"""Input workbook: fields of the models, their sheets, and a filled-in workbook as plain data.

Nothing here lists the fields of a conveyor; `conveyor.template` draws the same sheets.
"""
