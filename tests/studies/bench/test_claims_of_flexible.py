"""What is stated of the flexible benchmark holds where the rows say so, and not otherwise."""

from __future__ import annotations

import pytest

from studies.bench import flexible as bench
from studies.bench.race import Claim, Row

FINER = "rtol 3e-04"
SCENE_B = "flexible: scene B at 1 % of N_max over scipy's rigid cycle at rtol 1e-10, time"


def claims(seconds: float, error: float, peak: float) -> dict[str, Claim]:
    """Of ours with such times and errors; all nodes take 30 s, and scipy's rigid cycle one."""
    rows = [
        Row("hoop-pulse reduced", setting, bench.SCENE_B, [seconds], error, more={"error_peak": peak})
        for setting in (bench.BEST, FINER)
    ]
    rows.append(Row("hoop-pulse all nodes", bench.BEST, bench.SCENE_B, [30.0], 0.0, more={"error_peak": 0.0}))
    rows.append(Row("hoop-pulse reduced", bench.BEST, bench.MASSLESS, [seconds], error))
    rows.append(Row(bench.SCIPY, "rtol 1e-10", "rigid cycle", [1.0]))
    return {claim.name: claim for claim in bench._claims(rows)}


@pytest.mark.parametrize(("seconds", "error", "peak", "holds"), [(1.0, 1e-4, 1e-3, True), (3.0, 1e-2, 0.1, False)])
def test_all_claims_follow_from_the_rows(seconds, error, peak, holds):
    """Good rows and bad ones, on either side of all that is stated: 20 times as fast, errors of 2e-3 and 2e-4, 1 % of
    the peak, one and a half of scipy's cycle. Of Exudyn, which was not run, nothing is said.
    """
    told = claims(seconds, error, peak)
    assert {name for name, claim in told.items() if claim.why_not} == {name for name in told if "Exudyn" in name}
    assert {claim.holds for claim in told.values() if not claim.why_not} == {holds}


def test_a_run_with_a_wrong_peak_is_not_among_the_good_ones():
    """However quick it is and however good its impulses are: two claims fail, and no other."""
    told = claims(1.0, 1e-4, 0.1)
    wrong = {name for name, claim in told.items() if not claim.holds}
    assert wrong == {SCENE_B, "flexible: error of the peak, scene B, rtol 3e-4"}
