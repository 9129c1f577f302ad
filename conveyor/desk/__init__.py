"""The desk: a design on a page of the browser, changed by hand and calculated at once.

`design_form` reads the fields from the models, `design_variant` the changes of a page, `design_sliders` chooses what is
moved most; `workbench` holds the open files and calculates, `answer_parts` makes the pieces of the page from tables;
`request_guard` refuses foreign requests, `desk_server` serves.
"""
