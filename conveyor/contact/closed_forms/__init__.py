"""Closed forms for indentation and line contact: oracles for the solvers, with equation numbers."""

from conveyor.contact.closed_forms.hertz import *
from conveyor.contact.closed_forms.hunter import *
from conveyor.contact.closed_forms.winkler import *
