"""Input models of a conveyor: frozen pydantic models of quantities, with their checks; nothing is computed."""

from conveyor.models.base import Model
from conveyor.models.belt import Belt, Carcass, Cover, TopCover
from conveyor.models.calculation_methods import CALIBRATED_FORCES, Calibration
from conveyor.models.cases import LoadCase, standard_cases
from conveyor.models.compound import RubberCompound
from conveyor.models.conveyor import Conveyor
from conveyor.models.drive import Drive, DrivePulley, FurtherDrive
from conveyor.models.drive_train import DrivePart
from conveyor.models.idlers import Idlers, IdlerSet
from conveyor.models.loop_parts import Pulley, TakeUp
from conveyor.models.material import BulkMaterial
from conveyor.models.motor_starter import Starter
from conveyor.models.operation import DutyEntry, EmissionFactor, EnergyPrice, Operation
from conveyor.models.parts import Ambient, Calculation
from conveyor.models.report import Report
from conveyor.models.rolls import Roll
from conveyor.models.route import Cleaner, Feeding, Route, Section
from conveyor.models.rubber_data import (
    ArrheniusShift,
    Band,
    FitStatistics,
    MeasuredRange,
    Prony,
    PronyTerm,
    Source,
    StrainDependence,
    TableShift,
    WLFShift,
)
from conveyor.models.runs import MeasuredRun
from conveyor.models.scenarios import Event, Scenario
from conveyor.models.uncertain_inputs import Correlation, Uncertainty
