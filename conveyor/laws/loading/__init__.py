"""From the mass flow to the line load on every roll: cross-sections, shares, load along a roll."""

from conveyor.laws.loading.bulk import *
from conveyor.laws.loading.curve_loads import *
from conveyor.laws.loading.heap import *
from conveyor.laws.loading.pipe import *
from conveyor.laws.loading.pipe_strip import *
from conveyor.laws.loading.roll_loading import *
from conveyor.laws.loading.wings import *
