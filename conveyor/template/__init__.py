"""The input template: the sheets of `conveyor.forms` drawn as a workbook and filled in from a conveyor."""
