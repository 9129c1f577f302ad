"""Resistances to motion of a belt conveyor: one cited equation, one function; SI in and out."""

from conveyor.laws.resistance.cema import *
from conveyor.laws.resistance.flexure import *
from conveyor.laws.resistance.idler_resistance import *
from conveyor.laws.resistance.main import *
from conveyor.laws.resistance.plough_drag import *
from conveyor.laws.resistance.pulleys import *
from conveyor.laws.resistance.resistance_defaults import *
from conveyor.laws.resistance.rim_drag import *
from conveyor.laws.resistance.roll_bearing import *
from conveyor.laws.resistance.secondary import *
from conveyor.laws.resistance.service_drag import *
from conveyor.laws.resistance.slider_bed import *
