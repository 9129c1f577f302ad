"""What a conveyor is made of: frozen models of quantities, data and checks only."""

from conveyor.models.base import Model
from conveyor.models.belt import Belt, Carcass, Cover, TopCover
from conveyor.models.compound import (
    ArrheniusShift,
    FitStatistics,
    MeasuredRange,
    Prony,
    PronyTerm,
    RubberCompound,
    Source,
    TableShift,
    WLFShift,
)
from conveyor.models.conveyor import Ambient, Calculation, Conveyor
from conveyor.models.drive import Drive, DrivePulley, EnergyPrice, FurtherDrive, Operation
from conveyor.models.idlers import Idlers, IdlerSet, Roll
from conveyor.models.material import BulkMaterial
from conveyor.models.route import Cleaner, Feeding, Pulley, Route, Section, TakeUp

__all__ = [
    "Ambient",
    "ArrheniusShift",
    "Belt",
    "BulkMaterial",
    "Calculation",
    "Carcass",
    "Cleaner",
    "Conveyor",
    "Cover",
    "Drive",
    "DrivePulley",
    "EnergyPrice",
    "Feeding",
    "FitStatistics",
    "FurtherDrive",
    "IdlerSet",
    "Idlers",
    "MeasuredRange",
    "Model",
    "Operation",
    "Prony",
    "PronyTerm",
    "Pulley",
    "Roll",
    "Route",
    "RubberCompound",
    "Section",
    "Source",
    "TableShift",
    "TakeUp",
    "TopCover",
    "WLFShift",
]
