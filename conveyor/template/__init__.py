"""The input template: a workbook made from the models, filled in by people, read back as plain data.

`layout` turns models into fields and tables, `plan` places them on sheets, `values` converts between spec
data and cells; `write` and `read` are the two directions. Nothing here lists the fields of a conveyor.
"""
