"""Two hundred bootstrap programmes on the shipped YuMi log.

No sample is visited again: every draw is a sum of the blocks' factors and one small programme.
"""

from benchmarks.demo_log import demo_log, demo_robot
from benchmarks.figures import Figure, processor_seconds
from veritorque.core.estimate.estimate import estimate
from veritorque.core.estimate.options import EstimateOptions
from veritorque.core.numerics.block_bootstrap import block_draws
from veritorque.core.precision.bootstrap import bootstrap
from veritorque.core.study import IdentifyRequest, identify_in_full

DRAWS = 200


def run(*, quick: bool) -> list[Figure]:
    """Time the draws alone."""
    draws = 20 if quick else DRAWS
    found = identify_in_full(IdentifyRequest(demo_robot(), (demo_log(),), {"bootstrap": {"draws": 0}}))
    options = EstimateOptions()
    once = processor_seconds(
        lambda: estimate(found.base, found.estimate.system, found.estimate.prior, options), repeats=3
    )
    spent = processor_seconds(
        lambda: bootstrap(
            found.estimate.system,
            tuple(block.factors for block in found.observation.blocks),
            found.observation.columns_of,
            lambda system: estimate(found.base, system, found.estimate.prior, options).base,
            block_draws(len(found.observation.blocks), draws, seed=0),
        ),
        repeats=1,
        least=0.0,
    )
    return [
        Figure(f"{draws} programmes, processor s", f"{spent:.2f}", "<= 3" if not quick else ""),
        Figure("one draw over one estimate", f"{spent / draws / once:.2f}", "", ratio=True),
    ]
