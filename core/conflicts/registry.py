"""List the kinds of conflict. A new kind is one file in `kinds` and one line here.

The order is that of preference: where two corrections predict equally well, the first is applied.
"""

from collections.abc import Mapping

from .conflict import Conflict
from .kinds.channels_swapped import ChannelsSwapped
from .kinds.convention import Convention
from .kinds.gear_ratio import GearRatio
from .kinds.gravity_compensated import GravityCompensated
from .kinds.link_length import LinkLength
from .kinds.mounting import Mounting
from .kinds.other_signal import OtherSignal
from .kinds.position_linkage import PositionLinkage
from .kinds.position_sign import PositionSign
from .kinds.torque_sign import TorqueSign
from .kinds.unit import Unit
from .kinds.zero_offset import ZeroOffset
from .kinds.zero_quarter_turn import ZeroQuarterTurn

_LISTED: tuple[Conflict, ...] = (
    TorqueSign(),
    PositionSign(),
    Mounting(),
    GravityCompensated(),
    ChannelsSwapped(),
    PositionLinkage(),
    ZeroQuarterTurn(),
    ZeroOffset(),
    Convention(),
    LinkLength(),
    OtherSignal(),
    Unit(),
    GearRatio(),
)
CONFLICTS: Mapping[str, Conflict] = {conflict.name: conflict for conflict in _LISTED}
"""The kinds of conflict by name."""
